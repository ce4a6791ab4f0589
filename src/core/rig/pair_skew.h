#pragma once

#include "geometry/plane_vector.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Movement of the camera in its own frame.
struct CameraRates {
  Eigen::Vector3d velocity;          ///< m/s
  Eigen::Vector3d angular_velocity;  ///< rad/s
};

/// Error of the plane vector g when the right image was taken `skew` seconds after the left one, 1/m. The
/// movement in between looks like disparity. To first order,
///   b dg = skew ((v_x + b q v_z) g + (-v_z q, -w_z, w_y)),
/// where q is the mean inverse depth of the points, 1/m.
Eigen::Vector3d planeErrorOfSkew(const StereoRig& rig, const PlaneVector& plane, double mean_inverse_depth,
                                 const CameraRates& rates, double skew);

/// The plane of a pair, with the effect of its skew added to the covariance. step: the camera's motion.
/// Without a step the camera is assumed to be as fast as a small aircraft.
GroundPlane withSkew(const StereoRig& rig, const StereoDepthResult& stereo,
                     const ApproachAngleResult::Motion& step);

/// Apparent direction of the baseline, because the right camera took its image `skew` seconds after the left
/// one and had moved by then. step: the camera's motion, trusted to a fifth. Without a step the direction is
/// 0, and its covariance allows for the speed of a small aircraft.
BaselineDirection baselineOfSkew(const StereoRig& rig, const StereoDepthResult& stereo,
                                 const ApproachAngleResult::Motion& step);

}  // namespace uav_landing
