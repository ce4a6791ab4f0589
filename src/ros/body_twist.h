#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// How a frame that is fixed to the aircraft moves against the ground, in its own axes.
struct BodyTwist {
  Eigen::Vector3d linear, angular;  ///< of its origin, m/s; rad/s
  Matrix6d covariance;              ///< linear first
};

/// camera: estimate of the left rectified camera, whose velocity is the mean over a step of this duration, s.
/// acceleration_stddev: m/s^2, by which the velocity now may be another. camera_from_child: the frame's pose
/// in the rectified left camera's frame. None while the velocity is not known.
std::optional<BodyTwist> bodyTwist(const LandingResult& camera, double duration, double acceleration_stddev,
                                   const Eigen::Isometry3d& camera_from_child);

}  // namespace uav_landing
