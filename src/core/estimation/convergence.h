#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace uav_landing {

/// Ends iterations when the remaining error is small compared with the uncertainty of the result. In
/// reweighted least squares each step leaves about the same share of the error before it. The first step
/// removes a bad start at once and does not show how fast the weights settle, so each step is assumed to
/// leave at least a fifth.
class Convergence {
 public:
  /// step: the last one, in standard deviations of the result.
  bool reached(double step) {
    constexpr double kLittle = 0.05;
    constexpr double kFirstShare = 0.5, kLeastShare = 0.2, kLargestShare = 0.99;
    const double share = last_ > 0 ? std::clamp(step / last_, kLeastShare, kLargestShare) : kFirstShare;
    last_ = step;
    return step * share / (1 - share) < kLittle;
  }
  /// The same by the step itself and the information (inverse covariance) of the result.
  template <int N>
  bool reached(const Eigen::Matrix<double, N, 1>& step, const Eigen::Matrix<double, N, N>& information) {
    return reached(std::sqrt(step.dot(information * step)));
  }

 private:
  double last_ = 0;
};

}  // namespace uav_landing
