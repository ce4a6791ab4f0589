#pragma once

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Fills pitch, roll, yaw and their variances. normal: of the ground, camera frame, covariance in rad^2.
/// landing_direction: of the runway, camera frame, covariance in rad^2; NaN leaves the yaw unknown.
void reportAttitude(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
                    const Eigen::Vector3d& landing_direction, const Eigen::Matrix3d& direction_covariance,
                    LandingResult& result);

}  // namespace uav_landing
