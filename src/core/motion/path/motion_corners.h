#pragma once

#include <vector>

#include "image/windows/corners.h"
#include "motion/path/motion_tracker.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Corners of a pair with their depth: of the plane for those on it, by their own disparity for the others.
std::vector<TrackedCorner> stereoCorners(const StereoRig& rig, const StereoDepthResult& stereo);

/// Corners on the ground, without stereo. mask: where they may be. normal: of the ground. memory: to work in.
std::vector<TrackedCorner> groundCorners(const StereoRig& rig, const cv::Mat& image, const cv::Mat& mask,
                                         const Eigen::Vector3d& normal,
                                         const ApproachAngleParameters& parameters, CornerMemory& memory);

}  // namespace uav_landing
