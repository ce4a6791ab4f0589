#pragma once

#include <Eigen/Core>

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Covariance of the pose runway <- child as in geometry_msgs/PoseWithCovariance: (x, y, z, rotations about
/// the runway's x, y and z), m^2, m rad, rad^2. An unknown yaw has a variance of pi^2.
/// camera: estimate of the left rectified camera.
/// plane: of the pair. Its covariance tells how the errors of height, pitch and roll are correlated. With an
/// invalid plane they are independent.
/// point: origin of the child in the left rectified camera's frame, m. It swings with the errors of the
/// attitude.
/// xy_variance: of the camera, m^2, huge while the runway is unknown.
Matrix6d poseCovariance(const LandingResult& camera, const GroundPlane& plane, const Eigen::Vector3d& point,
                        const Eigen::Vector2d& xy_variance);

/// Variance of the height of that point, m^2: element [2, 2] of poseCovariance(). camera_variance: of the
/// camera's height.
double heightVariance(const LandingResult& camera, double camera_variance, const GroundPlane& plane,
                      const Eigen::Vector3d& point);

}  // namespace uav_landing
