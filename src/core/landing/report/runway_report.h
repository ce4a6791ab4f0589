#pragma once

#include "landing/height/measured_height.h"
#include "landing/report/runway_track.h"

namespace uav_landing {

/// Source of the track's height.
HeightOrigin originOf(const MeasuredHeight& measured, const LandingResult& result);

/// Reports position and direction from the runway's outline until edges and threshold give them. Alone, a
/// position from the outline is reported only if it is certain enough. When both are known and agree, the
/// result is their weighted mean. So nothing jumps when one takes over from the other. When they contradict
/// each other, the outline is not used, and runway_failure says why. The outline alone gives no protection
/// level of y. sight: of this pair.
void handOver(const TrackedPosition& outline, const ApproachAngleResult::Sight& sight, LandingResult& result);

/// Reports the height above the runway with its protection level, limit and origin. It comes from stereo (see
/// runwayHeight()) and from the outline. When both are known, they are weighted by their variances. It is
/// unknown when they contradict each other before the threshold. bend, width_known: see runwayHeight().
void reportHeightAboveRunway(const TrackedPosition& outline, double bend, bool width_known,
                             const KalmanHeightParameters& parameters, LandingResult& result);

}  // namespace uav_landing
