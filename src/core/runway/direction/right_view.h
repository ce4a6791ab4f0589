#pragma once

#include <vector>

#include "lines/segments/line_segment.h"
#include "runway/direction/seen_ground.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Predicts where the right rectified view sees lines of the left one, if they are on the ground. Ends may
/// lie outside the image.
std::vector<RoughSegment> linesInRightView(const StereoRig& rig, const SeenGround& ground,
                                           const std::vector<LineSegment>& lines);

}  // namespace uav_landing
