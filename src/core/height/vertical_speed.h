#pragma once

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A vertical speed, positive up, m/s, and its variance, m^2/s^2.
struct VerticalSpeed {
  double speed = kUnknown;
  double variance = kUnknown;
};

/// Vertical speed v = -(n.t/h) h / T of the step from the previous frame. plane, height, height_variance:
/// ground plane and height (m, m^2) now. slope_error: 1 sigma by which the surface below is inclined to the
/// plane seen ahead, rad. acceleration_stddev: m/s^2; the step's mean speed is that of its middle, T/2 ago.
/// NaN when the step has no motion.
VerticalSpeed verticalSpeed(const ApproachAngleResult::Motion& step, const GroundPlane& plane, double height,
                            double height_variance, double slope_error, double acceleration_stddev);

/// As uncertain as durations between stamps are as well. duration_variance: of them, over their squares.
VerticalSpeed withDurations(VerticalSpeed speed, double duration_variance);

}  // namespace uav_landing
