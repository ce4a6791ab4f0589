#pragma once

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The ground as stereo sees it.
struct SeenGround {
  GroundPlane plane;
  RigRotation rows;  ///< what vertical disparities tell, or unknown
  /// Whether a runway is followed on it already: then nothing depends on lines that are not there.
  bool has_runway = false;
};

}  // namespace uav_landing
