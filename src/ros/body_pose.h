#pragma once

#include <Eigen/Geometry>

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Rotation runway <- rectified left camera (optical frame): Rz(yaw) Ry(-pitch) Rx(roll) of its
/// forward-left-up axes. An unknown yaw counts as 0. None of the rows is finite when pitch or roll is
/// unknown.
Eigen::Matrix3d runwayFromCamera(const LandingResult& camera);

/// How much higher a point of the rectified left camera's optical frame (m) comes by a radian more of roll or
/// of pitch, m.
double heightByRoll(const LandingResult& camera, const Eigen::Vector3d& point);
double heightByPitch(const LandingResult& camera, const Eigen::Vector3d& point);

/// The estimate of the left rectified camera turned into that of a point fixed to the aircraft. point: in the
/// rectified left camera's optical frame, m. plane: of the pair, from which height and attitude err together.
/// Heights move by -n.point, with variances as in poseCovariance, x and y by the point turned into the runway
/// frame; the vertical speed by the rotation of step, without which it is unknown. Angles and velocity stay
/// those of the camera. The protection level grows by how the point swings with the attitude, as large as
/// belongs to integrity_risk. The height is not valid where that is above the alert limit then, or where the
/// point's height is too uncertain (height_limit.h). Without an attitude it is unknown and not valid.
LandingResult referTo(const Eigen::Vector3d& point, const LandingResult& camera, const GroundPlane& plane,
                      const ApproachAngleResult::Motion& step, const KalmanHeightParameters& parameters);

}  // namespace uav_landing
