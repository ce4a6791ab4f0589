#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "motion/matching/temporal_match.h"
#include "motion/step/ego_motion.h"

namespace uav_landing {

/// Tests whether the corners lie on one plane. Returns no failure when their motion shows that they do, else
/// plane_unproven.
///
/// Without stereo there is no other proof. In a street, or in front of houses, some of the corners always
/// agree on a motion over some plane, and its angle is wrong by tens of degrees. So the test takes all
/// corners with more contrast than noise has. Seven in ten of them must be found where the motion over the
/// plane puts them. Over runways, grass and water nine in ten are; in streets it is less than half.
///
/// image: the one with the corners, smoothed or not. corners: all that were looked for, as if on the ground.
/// matches: those that were followed. estimate: the motion that was estimated from these matches.
Failure doubtOfPlane(const cv::Mat& image, const std::vector<TrackedCorner>& corners,
                     const std::vector<TemporalMatch>& matches, const MotionEstimate& estimate);

}  // namespace uav_landing
