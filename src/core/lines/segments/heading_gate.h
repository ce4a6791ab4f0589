#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// Tells which lines of a view may lie along the runway, if they are on the ground, by where they meet its
/// horizon. Most lines of texture run across and are rejected.
class HeadingGate {
 public:
  /// K: 3x3 of the rectified view. normal: of the ground, in that view's frame. max_yaw: largest angle
  /// between runway and optical axis, rad; lines pass when they exceed it by a few degrees.
  HeadingGate(const Eigen::Matrix3d& K, const Eigen::Vector3d& normal, double max_yaw);

  /// line: homogeneous, any scale.
  bool passes(const Eigen::Vector3d& line) const;

 private:
  Eigen::Vector3d ahead_, aside_;  // parts of a line's direction on the ground
  double slope_;                   // tangent of the largest angle to the optical axis
};

}  // namespace uav_landing
