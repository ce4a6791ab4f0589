#pragma once

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A vertical speed, positive up, m/s, and its variance, m^2/s^2.
struct VerticalSpeed {
  double speed = kUnknown;
  double variance = kUnknown;
};

/// Errors of a vertical speed, besides those of the step and the plane.
struct VerticalSpeedErrors {
  double height_variance = 0;  ///< m^2
  double slope = 0;            ///< 1 sigma of the slope of the surface below against the plane ahead, rad
  double acceleration = 0;     ///< 1 sigma, m/s^2, because the step's mean speed is that of T/2 ago
};

/// Vertical speed v = -(n.t/h) h / T of the step from the previous pair. plane, height: ground plane
/// and height (m) now. NaN when the step has no motion.
VerticalSpeed verticalSpeed(const ApproachAngleResult::Motion& step, const GroundPlane& plane, double height,
                            const VerticalSpeedErrors& errors);

/// Adds the uncertainty of the durations between stamps. duration_variance: of a duration, over its square.
VerticalSpeed withDurations(VerticalSpeed speed, double duration_variance);

}  // namespace uav_landing
