#pragma once

#include <Eigen/Geometry>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Rotation runway <- rectified left camera (optical frame): Rz(yaw) Ry(-pitch) Rx(roll) of its
/// forward-left-up axes. An unknown yaw counts as 0. None of the rows is finite when pitch or roll is
/// unknown.
Eigen::Matrix3d runwayFromCamera(const LandingResult& camera);

/// The estimate of the left rectified camera turned into that of a point fixed to the aircraft. point: in the
/// rectified left camera's optical frame, m. Heights move by -n.point with the variance of the attitude, x
/// and y by the point turned into the runway frame; the vertical speed by the rotation of step, without which
/// it is unknown. Angles and velocity stay those of the camera. Without an attitude the point's height is
/// unknown and not valid.
LandingResult referTo(const Eigen::Vector3d& point, const LandingResult& camera,
                      const ApproachAngleResult::Motion& step);

}  // namespace uav_landing
