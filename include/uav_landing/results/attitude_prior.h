#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/row_turns.h"

namespace uav_landing {

/// Knowledge of an inertial sensor about a pair, in the optical frame of the rectified left camera. Unknown
/// numbers are NaN.
struct AttitudePrior {
  Failure failure{Reason::kNotYet, "no imu message"};  ///< why there is no normal
  /// Unit normal of level ground, pointing down: the direction of gravity.
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(std::nan(""));
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Constant(std::nan(""));  ///< rad^2, rank 2
  double duration = std::nan("");  ///< time of the rotation, s: since the pair before
  /// Rotation vector of R, rad. A point at rest moves as x_now = R x_then.
  Eigen::Vector3d rotation = Eigen::Vector3d::Constant(std::nan(""));
  Eigen::Matrix3d rotation_covariance = Eigen::Matrix3d::Constant(std::nan(""));  ///< rad^2

  /// Turns while the rows of a rolling shutter are exposed; null: not known, for rows_failure.
  std::shared_ptr<const RowTurns> rows;
  Failure rows_failure;

  bool hasNormal() const { return normal.allFinite() && normal_covariance.allFinite(); }
  bool hasRotation() const { return rotation.allFinite() && rotation_covariance.allFinite() && duration > 0; }
};

}  // namespace uav_landing
