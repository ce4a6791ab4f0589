#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Motion against the ground of a frame that is fixed to the aircraft, in its own axes.
struct BodyTwist {
  Eigen::Vector3d linear, angular;  ///< of its origin, m/s; rad/s
  Matrix6d covariance;              ///< linear first
};

/// Twist of a frame from the estimate of the left rectified camera. There is none while the velocity is
/// unknown.
/// duration: of the frame step, s. The camera's velocity is the mean over it.
/// acceleration_stddev: m/s^2. The velocity now may differ from this mean by the acceleration.
/// camera_from_child: pose of the frame in the rectified left camera's frame.
std::optional<BodyTwist> bodyTwist(const LandingResult& camera, double duration, double acceleration_stddev,
                                   const Eigen::Isometry3d& camera_from_child);

}  // namespace uav_landing
