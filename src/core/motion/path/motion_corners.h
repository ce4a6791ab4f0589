#pragma once

#include <vector>

#include "image/input/rectified_view.h"
#include "image/windows/corners.h"
#include "motion/path/motion_tracker.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Corners of the stereo result, with inverse depths in units of one over the height. A corner on the plane
/// has the plane's depth; any other has that of its own disparity. Corners off the plane with less than one
/// pixel of disparity are not used.
std::vector<TrackedCorner> stereoCorners(const StereoRig& rig, const StereoDepthResult& stereo);

/// Corners for use without stereo; all are assumed to lie on the ground. view: of the left camera. normal: of
/// the ground; corners are looked for below its horizon only. memory: working memory.
std::vector<TrackedCorner> groundCorners(const StereoRig& rig, const RectifiedView& view,
                                         const Eigen::Vector3d& normal,
                                         const ApproachAngleParameters& parameters, CornerMemory& memory);

}  // namespace uav_landing
