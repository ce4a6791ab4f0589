#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// Tells the lines of one view that may lie along the runway from those that cannot if they are on the
/// ground: by where they meet its horizon. Most lines of texture run across.
class HeadingGate {
 public:
  /// K: 3x3 of the rectified view. normal: of the ground, its frame. max_yaw: largest angle between runway
  /// and optical axis, rad; lines may be off by some degrees more.
  HeadingGate(const Eigen::Matrix3d& K, const Eigen::Vector3d& normal, double max_yaw);

  /// line: homogeneous, any scale.
  bool passes(const Eigen::Vector3d& line) const;

 private:
  Eigen::Vector3d ahead_, aside_;  // of a line: the parts of its direction on the ground
  double slope_;                   // tangent of the largest angle to the optical axis
};

}  // namespace uav_landing
