#pragma once

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A height above the plane of the runway's surface, m, m^2: z in the runway frame. It does not change where
/// the ground before the runway is higher or lower. The height above what is straight below does.
struct RunwayHeight {
  double height = kUnknown, variance = kUnknown;
};

/// Unknown until the threshold has been seen, and while the height is not valid.
///
/// Before the threshold it is the height above the plane of the ground ahead. That ground may slope against
/// the runway on the way that is left, which is in the variance. Where the runway's width is known, it is the
/// weighted mean with the height by the width. It is unknown where the two contradict each other.
///
/// landing: with height, x and width_height. bend: of the surface below less the plane ahead, m. width_known:
/// width_height does not come from stereo heights.
RunwayHeight runwayHeight(const LandingResult& landing, double bend, bool width_known);

}  // namespace uav_landing
