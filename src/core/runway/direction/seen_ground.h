#pragma once

#include <optional>

#include "geometry/stamp_map.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/parameters/runway_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The ground as stereo sees it.
struct SeenGround {
  GroundPlane plane;
  RigRotation rows;  ///< what vertical disparities tell, or unknown
  /// Whether a runway is followed on it already: then nothing depends on lines that are not there.
  bool has_runway = false;
  /// Directions in the pair before, unit, frame of the camera: of flight, and of the runway.
  std::optional<Eigen::Vector3d> path = std::nullopt, last = std::nullopt;
  RunwayParameters runway = {};  ///< what charts say of it
  double last_doubt = 0;         ///< chance that the last direction was not the runway's
};

/// Of both rectified views: where their pixels would be had all rows been exposed at the stamp.
struct ViewRows {
  StampMap left, right;
};

}  // namespace uav_landing
