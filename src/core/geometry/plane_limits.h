#pragma once

#include "geometry/plane_vector.h"

namespace uav_landing {

/// Limits of a plausible ground plane.
struct PlaneLimits {
  double max_roll = 0;   ///< rad
  double max_pitch = 0;  ///< rad
  int min_points = 0;
  double tolerance = 1.0;  ///< pixels of disparity in the consensus step
};

/// True when the plane lies below the camera, with pitch and roll within the limits.
bool isPlausibleGround(const PlaneVector& g, const PlaneLimits& limits);

}  // namespace uav_landing
