#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "geometry/plane_vector.h"
#include "stereo/matching/corner_matching.h"
#include "stereo/matching/stereo_level.h"
#include "stereo/plane/plane_consensus.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// Plane near a predicted one (1/m): matches within search_radius, then consensus. Not found when too few
/// agree.
std::optional<Consensus> trackPlane(const StereoLevel& level, const PlaneVector& predicted,
                                    const StereoDepthParameters& parameters, const PlaneLimits& limits,
                                    GroundCornerMemory& memory);

/// Corners that were found at full size, for use at a smaller one.
struct FullSizeCorners {
  const std::vector<cv::Point>& places;  ///< at full size
  int factor;                            ///< full size over the smaller one
};

/// The same by a few scouts among the corners. Not found unless most of the scouts agree.
std::optional<Consensus> trackPlaneByScouts(const StereoLevel& level, const FullSizeCorners& corners,
                                            const PlaneVector& predicted,
                                            const StereoDepthParameters& parameters,
                                            const PlaneLimits& limits);

}  // namespace uav_landing
