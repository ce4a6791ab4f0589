#pragma once

#include <Eigen/Core>

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Covariance of the pose runway <- child as in geometry_msgs/PoseWithCovariance: (x, y, z, rotations about
/// the runway's x, y and z), m^2, m rad, rad^2. camera: estimate of the left rectified camera. plane: of the
/// pair, from which the errors of height, pitch and roll are correlated; with an invalid one they are
/// independent. point: origin of the child in the left rectified camera's frame, m; it swings with the errors
/// of the attitude. xy_variance: of the camera, m^2, huge while the runway is unknown. An unknown yaw has a
/// variance of pi^2.
Matrix6d poseCovariance(const LandingResult& camera, const GroundPlane& plane, const Eigen::Vector3d& point,
                        const Eigen::Vector2d& xy_variance);

/// Variance of the height of that point, m^2, when the camera's height has camera_variance: poseCovariance's
/// [2, 2].
double heightVariance(const LandingResult& camera, double camera_variance, const GroundPlane& plane,
                      const Eigen::Vector3d& point);

}  // namespace uav_landing
