#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Centres of pairs of edges and how well they are known, by columns, as all are compared with all. Floats
/// are exact enough to say which are certainly apart, and twice as many at once.
class CentreColumns {
 public:
  /// variance: of the centre; by_rotation: its derivatives by rotations that are common to all.
  void add(double centre, double variance, const Eigen::Vector3d& by_rotation);

  /// Sets 1 for centres that are certainly farther from one of them than this many sigma of the difference,
  /// and 0 for the others. spread: trace of the rotations' covariance, which bounds what that makes of a
  /// vector.
  void markApart(std::ptrdiff_t one, double sigmas, double spread, uchar* apart) const;

 private:
  std::vector<float> centres_, variances_;
  std::array<std::vector<float>, 3> by_rotation_;
};

}  // namespace uav_landing
