#pragma once

#include <opencv2/core.hpp>

#include "stereo/matching/plane_drift.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {

/// Both rectified images at one resolution, with the rig and the masks at that resolution.
struct StereoLevel {
  StereoRig rig;
  cv::Mat left_mask, right_mask;  ///< mono8, already eroded by the matching window
  cv::Mat left, right;            ///< CV_32F, smoothed
  PlaneDrift drift = {};          ///< of the ground; at full resolution only
};

/// Rig and masks at a resolution reduced by an integer factor. The masks are eroded by margin pixels there.
StereoLevel reduceLevel(const RigModel& model, int factor, int margin);

/// The same pair with left and right exchanged. It tells a swapped rig from images without features.
StereoLevel swapped(const StereoLevel& level);

/// The same pair as seen by cameras that are turned by 180 deg about their axes: images turned, left and
/// right exchanged. It shows whether a rig is mounted upside down.
StereoLevel turnedOver(const StereoLevel& level);

}  // namespace uav_landing
