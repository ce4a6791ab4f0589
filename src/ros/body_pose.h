#pragma once

#include <Eigen/Geometry>

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Rotation runway <- rectified left camera (optical frame): Rz(yaw) Ry(-pitch) Rx(roll) of its
/// forward-left-up axes. An unknown yaw counts as 0. No row is finite when pitch or roll is unknown.
Eigen::Matrix3d runwayFromCamera(const LandingResult& camera);

/// Rise of a point per radian of roll, or of pitch, m. point: in the rectified left camera's optical frame,
/// m.
double heightByRoll(const LandingResult& camera, const Eigen::Vector3d& point);
double heightByPitch(const LandingResult& camera, const Eigen::Vector3d& point);

/// Turns the estimate of the left rectified camera into that of a point that is fixed to the aircraft.
/// point: in the rectified left camera's optical frame, m.
/// plane: of the pair. Its covariance tells how the errors of height and attitude are correlated.
/// step: frame step.
///
/// Heights change by -n.point, with variances as in poseCovariance(). x and y change by the point turned into
/// the runway frame. The vertical speed changes by the rotation of the step; without one it is unknown.
/// Angles and velocity stay those of the camera.
///
/// The protection level grows by the swing of the point with the attitude's error, at integrity_risk. The
/// height is not valid when this level then exceeds the alert limit, or when the point's height is too
/// uncertain (height_limit.h). Without an attitude the height is unknown and not valid.
LandingResult referTo(const Eigen::Vector3d& point, const LandingResult& camera, const GroundPlane& plane,
                      const ApproachAngleResult::Motion& step, const KalmanHeightParameters& parameters);

}  // namespace uav_landing
