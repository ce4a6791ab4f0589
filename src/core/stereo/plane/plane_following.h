#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "stereo/matching/corner_matching.h"
#include "stereo/matching/stereo_level.h"
#include "stereo/plane/plane_consensus.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// Plane near a predicted one: matches within search_radius, then consensus. Not found when too few agree.
Consensus trackPlane(const StereoLevel& level, const Eigen::Vector3d& predicted,
                     const StereoDepthParameters& parameters, const PlaneLimits& limits,
                     GroundCornerMemory& memory);

/// The same by a few of the corners found at full size, this factor larger than the level. Not found unless
/// most of them agree.
Consensus trackPlaneByScouts(const StereoLevel& level, const std::vector<cv::Point>& corners, int factor,
                             const Eigen::Vector3d& predicted, const StereoDepthParameters& parameters,
                             const PlaneLimits& limits);

}  // namespace uav_landing
