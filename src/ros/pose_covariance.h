#pragma once

#include <Eigen/Core>

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Covariance of the pose runway <- child as geometry_msgs/PoseWithCovariance has it: (x, y, z, rotations
/// about the runway's x, y and z), m^2, m rad, rad^2. camera: estimate of the left rectified camera. plane:
/// of the pair, from which height, pitch and roll err together; an invalid one leaves them independent.
/// point: the child's origin in the left rectified camera's frame, m: it swings with the errors of the
/// attitude. xy_variance: of the camera, m^2, huge while the runway is not known. An unknown yaw has a
/// variance of pi^2.
Matrix6d poseCovariance(const LandingResult& camera, const GroundPlane& plane, const Eigen::Vector3d& point,
                        const Eigen::Vector2d& xy_variance);

/// Variance of the height of that point, m^2, where that of the camera has this one: poseCovariance's [2, 2].
double heightVariance(const LandingResult& camera, double camera_variance, const GroundPlane& plane,
                      const Eigen::Vector3d& point);

}  // namespace uav_landing
