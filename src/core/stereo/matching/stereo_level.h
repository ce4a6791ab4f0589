#pragma once

#include <opencv2/core.hpp>

#include "stereo/matching/plane_drift.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {

/// Both rectified images at one resolution with the rig and masks that belong to it.
struct StereoLevel {
  StereoRig rig;
  cv::Mat left_mask, right_mask;  ///< mono8, already eroded by the matching window
  cv::Mat left, right;            ///< CV_32F, smoothed
  PlaneDrift drift = {};          ///< of the ground; at full resolution only
};

/// Rig and masks at a resolution reduced by an integer factor; the masks are eroded by margin pixels there.
StereoLevel reduceLevel(const RigModel& model, int factor, int margin);

/// The same pair with left and right exchanged (to tell a swapped rig from a featureless one).
StereoLevel swapped(const StereoLevel& level);

}  // namespace uav_landing
