#pragma once

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A vertical speed, positive up, m/s, and its variance, m^2/s^2.
struct VerticalSpeed {
  double speed = kUnknown;
  double variance = kUnknown;
};

/// Vertical speed v = -(n.t/h) h / T of the step from the previous pair. plane, height, height_variance:
/// ground plane and height (m, m^2) now. slope_error: 1 sigma of the slope of the surface below against the
/// plane ahead, rad. acceleration_stddev: m/s^2; it enters because the step's mean speed is that of T/2 ago.
/// NaN when the step has no motion.
VerticalSpeed verticalSpeed(const ApproachAngleResult::Motion& step, const GroundPlane& plane, double height,
                            double height_variance, double slope_error, double acceleration_stddev);

/// Adds the uncertainty of the durations between stamps. duration_variance: of a duration, over its square.
VerticalSpeed withDurations(VerticalSpeed speed, double duration_variance);

}  // namespace uav_landing
