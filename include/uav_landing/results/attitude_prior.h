#pragma once

#include <Eigen/Core>
#include <cmath>

#include "uav_landing/base/failure.h"

namespace uav_landing {

/// What an inertial sensor knows of one pair beforehand, in the rectified left camera's optical frame. NaN
/// where it says nothing.
struct AttitudePrior {
  Failure failure{Reason::kNotYet, "no imu message"};  ///< why there is no normal
  /// Normal of level ground, unit, down: the direction of gravity.
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(std::nan(""));
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Constant(std::nan(""));  ///< rad^2, rank 2
  double duration = std::nan("");  ///< of the rotation, s: back to the pair before
  /// Rotation vector of R, x_now = R x_then for what is at rest. rad.
  Eigen::Vector3d rotation = Eigen::Vector3d::Constant(std::nan(""));
  Eigen::Matrix3d rotation_covariance = Eigen::Matrix3d::Constant(std::nan(""));  ///< rad^2

  bool hasNormal() const { return normal.allFinite() && normal_covariance.allFinite(); }
  bool hasRotation() const { return rotation.allFinite() && rotation_covariance.allFinite() && duration > 0; }
};

}  // namespace uav_landing
