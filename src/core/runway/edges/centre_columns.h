#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Centres of pairs of edges and their uncertainty, stored by columns because all are compared with all.
/// Floats are exact enough to tell which centres are certainly apart, and twice as many fit into one
/// instruction.
class CentreColumns {
 public:
  /// variance: of the centre, without the rotations. by_rotation: derivatives of the centre by rotations that
  /// are common to all pairs.
  void add(double centre, double variance, const Eigen::Vector3d& by_rotation);

  /// Sets 1 for each centre that is certainly far from one of them: by more than `sigmas` standard deviations
  /// of the difference. Sets 0 for the others. one: its index. spread: trace of the covariance of the
  /// rotations, an upper bound for their effect.
  void markApart(std::ptrdiff_t one, double sigmas, double spread, uchar* apart) const;

 private:
  std::vector<float> centres_, variances_;
  std::array<std::vector<float>, 3> by_rotation_;
};

}  // namespace uav_landing
