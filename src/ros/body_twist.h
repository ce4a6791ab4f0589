#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Motion of a frame that is fixed to the aircraft against the ground, in its own axes.
struct BodyTwist {
  Eigen::Vector3d linear, angular;  ///< of its origin, m/s; rad/s
  Matrix6d covariance;              ///< linear first
};

/// Twist of a frame from the estimate of the left rectified camera. duration: of the frame step over which
/// the camera's velocity is the mean, s. acceleration_stddev: m/s^2, as the velocity now may differ from this
/// mean. camera_from_child: pose of the frame in the rectified left camera's frame. None while the velocity
/// is unknown.
std::optional<BodyTwist> bodyTwist(const LandingResult& camera, double duration, double acceleration_stddev,
                                   const Eigen::Isometry3d& camera_from_child);

}  // namespace uav_landing
