#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace uav_landing {

/// Ends iterations of which each leaves about the same share of what the one before left, as those of
/// reweighted least squares do, when what is left is little beside what is known at all. A first step takes
/// away a start that is far off at once, and tells nothing of how fast the weights settle: a fifth is what is
/// left by each at least.
class Convergence {
 public:
  /// step: the one just made, in standard deviations of what is sought.
  bool reached(double step) {
    constexpr double kLittle = 0.05;
    constexpr double kFirstShare = 0.5, kLeastShare = 0.2, kLargestShare = 0.99;
    const double share = last_ > 0 ? std::clamp(step / last_, kLeastShare, kLargestShare) : kFirstShare;
    last_ = step;
    return step * share / (1 - share) < kLittle;
  }
  /// The same by the step itself and the information (inverse covariance) of what is sought.
  template <int N>
  bool reached(const Eigen::Matrix<double, N, 1>& step, const Eigen::Matrix<double, N, N>& information) {
    return reached(std::sqrt(step.dot(information * step)));
  }

 private:
  double last_ = 0;
};

}  // namespace uav_landing
