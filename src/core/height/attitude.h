#pragma once

#include <optional>

#include "geometry/ground_normal.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Fills pitch, roll, yaw and their variances, as far as normal and direction of the runway are known. Both
/// are in the camera frame.
void reportAttitude(const std::optional<GroundNormal>& normal,
                    const std::optional<GroundDirection>& landing_direction, LandingResult& result);

}  // namespace uav_landing
