#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace uav_landing {

/// Which lines of a picture may run along the runway, if they are on ground with this normal: those that run
/// within max_yaw of the optical axis there. Most lines of texture run across, and need not be looked at.
class AlongRunway {
 public:
  /// K: 3x3 of the rectified view. normal: of the ground, up, camera frame. max_yaw: rad.
  AlongRunway(const Eigen::Matrix3d& K, const Eigen::Vector3d& normal, double max_yaw)
      : K_(K), normal_(normal), widest_(std::min(max_yaw + kSlack, M_PI_2)) {}

  /// line: homogeneous, pixels.
  bool has(const Eigen::Vector3d& line) const {
    const Eigen::Vector3d along = (K_.transpose() * line).cross(normal_);
    return std::abs(along.x()) * std::cos(widest_) <= std::abs(along.z()) * std::sin(widest_);
  }
  /// Share of lines of random direction on the ground.
  double share() const { return widest_ / M_PI_2; }

 private:
  static constexpr double kSlack = 5 * M_PI / 180;  // by which a rough line's direction may be off

  Eigen::Matrix3d K_;
  Eigen::Vector3d normal_;
  double widest_;
};

}  // namespace uav_landing
