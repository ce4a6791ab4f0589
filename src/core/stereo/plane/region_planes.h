#pragma once

#include <array>
#include <vector>

#include "image/image_region.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The ground plane from the matched points outside of each region.
struct RegionPlanes {
  GroundPlane all;  ///< from all points; compare with this one: the pair's own plane may be from grey levels
  std::array<GroundPlane, kImageRegions> without;  ///< not valid() where too few points are left
};

/// points: of the pair, on the plane or not; plane: of the pair, where the robust fits start. The covariances
/// are of random errors only, and none is smaller than its share of the points allows: few points tell their
/// own scatter badly. Without points nothing is valid.
RegionPlanes planesWithoutRegions(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                                  const Eigen::Vector3d& plane);

}  // namespace uav_landing
