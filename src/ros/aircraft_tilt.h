#pragma once

#include <Eigen/Core>
#include <string>

#include "rig_frames.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Cosine of 60 degrees. No landing aircraft is tilted by more, so beyond it a frame has wrong axes.
constexpr double kMinCosTilt = 0.5;

/// Cosine of the angle between a frame's z axis and the vertical. runway_from_frame: its rotation.
inline double cosTilt(const Eigen::Matrix3d& runway_from_frame) { return runway_from_frame(2, 2); }
/// This angle for people, in whole degrees.
double tiltInDegrees(double cos_tilt);

/// Tests whether the axes of the rig's frames can be right: the aircraft's up axis has to be within 60
/// degrees of the vertical. A wrong frame_id of the camera, one that is a body frame (forward-left-up,
/// forward-right-down), turns this axis and the lever arm by about 90 degrees.
///
/// The mounting alone shows that, with the rectified camera taken as level. So the mistake is found before an
/// attitude is known, however far the camera looks down. The estimated attitude counts only while something
/// is valid, because a wrong attitude has a reason of its own.
/// rectified_from_child: rotation of the frame that is estimated into the rectified left camera.
/// left_frame: frame_id of the left camera_info.
Failure wrongTilt(const RigFrames::Child& child, const Eigen::Matrix3d& rectified_from_child,
                  const LandingResult& camera, const std::string& left_frame);

}  // namespace uav_landing
