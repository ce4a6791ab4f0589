#pragma once

#include <optional>

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/parameters/runway_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The ground as stereo sees it, with what earlier pairs and charts say about the runway on it.
struct SeenGround {
  GroundPlane plane;
  RigRotation rows;  ///< from vertical disparities; may be unknown
  /// Whether a runway is already followed on it. Then missing lines are not used as evidence.
  bool has_runway = false;
  /// Directions in the previous pair, unit, camera frame: of flight, and of the runway.
  std::optional<Eigen::Vector3d> path = std::nullopt, last = std::nullopt;
  RunwayParameters runway = {};  ///< data of the chart
  double last_doubt = 0;         ///< chance that `last` was not the runway's direction
};

}  // namespace uav_landing
