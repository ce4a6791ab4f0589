#pragma once

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Movement of the camera in its own frame.
struct CameraRates {
  Eigen::Vector3d velocity;          ///< m/s
  Eigen::Vector3d angular_velocity;  ///< rad/s
};

/// Error of the plane vector g when the right image was taken `skew` seconds after the left one: the movement
/// in between looks like disparity, to first order
///   b dg = skew ((v_x + b q v_z) g + (-v_z q, -w_z, w_y)),
/// with q the mean inverse depth of the points, 1/m. Returned in 1/m.
Eigen::Vector3d planeErrorOfSkew(const StereoRig& rig, const Eigen::Vector3d& g, double mean_inverse_depth,
                                 const CameraRates& rates, double skew);

/// The plane of a pair with the covariance that its skew adds. step: tells how the camera moves; without it
/// the movement is taken to be as fast as that of a small aircraft.
GroundPlane withSkew(const StereoRig& rig, const StereoDepthResult& stereo,
                     const ApproachAngleResult::Motion& step);

/// Where the right camera was beside its place when its image was taken, skew after the left one. step: tells
/// the way, to a fifth; without it the camera may be as fast as that of a small aircraft.
BaselineDirection baselineOfSkew(const StereoRig& rig, const StereoDepthResult& stereo,
                                 const ApproachAngleResult::Motion& step);

}  // namespace uav_landing
