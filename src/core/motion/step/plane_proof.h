#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "motion/matching/temporal_match.h"
#include "motion/step/ego_motion.h"

namespace uav_landing {

/// Why corners may not be those of one plane; none when their motion shows that they are.
///
/// Without stereo nothing else tells. In a street, or in front of houses, a part of the corners always agrees
/// on some motion over some plane, and its angle is off by tens of degrees. So of all corners that can be
/// told from noise seven in ten have to be found where the motion over the plane puts them. Over runways,
/// grass and water nine in ten are; in streets less than half.
///
/// image: of the corners, smoothed or not. corners: all that were looked for, on the ground if it is a plane.
/// matches: those that were followed, with what the estimate says of each.
Failure doubtOfPlane(const cv::Mat& image, const std::vector<TrackedCorner>& corners,
                     const std::vector<TemporalMatch>& matches, const MotionEstimate& estimate);

}  // namespace uav_landing
