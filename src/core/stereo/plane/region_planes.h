#pragma once

#include <array>
#include <vector>

#include "geometry/plane_vector.h"
#include "image/input/image_region.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The ground plane from the matched points outside each region.
struct RegionPlanes {
  GroundPlane all;  ///< from all points; compare with this, as the pair's own plane may come from grey levels
  std::array<GroundPlane, kImageRegions> without;  ///< not valid() when too few points are left
};

/// points: of the pair, on the plane or not. plane: of the pair; the robust fits start there. The
/// covariances contain random errors only. None is smaller than its share of the points allows, as few points
/// estimate their own scatter badly. Without points no plane is valid.
RegionPlanes planesWithoutRegions(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                                  const PlaneVector& plane);

}  // namespace uav_landing
