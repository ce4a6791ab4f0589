#pragma once

#include "landing/height/measured_height.h"
#include "landing/report/runway_track.h"

namespace uav_landing {

/// Of the height of the track.
HeightOrigin originOf(const MeasuredHeight& measured, const LandingResult& result);

/// Position and direction by the runway's outline, where edges and threshold have not told them yet. Where
/// both are known, and the outline's scale is a chart's, they are the weighted mean: so nothing jumps where
/// the one takes over from the other. Where they contradict each other the outline's is left out, and the
/// reason says so. sight: of this pair.
void handOver(const TrackedPosition& outline, const ApproachAngleResult::Sight& sight, LandingResult& result);

/// The height above the runway with its protection level, limit and origin: by stereo (see runwayHeight())
/// and by the outline, as far as they are known, weighted by their variances. Unknown where they contradict
/// each other before the threshold. bend, width_known: see runwayHeight().
void reportHeightAboveRunway(const TrackedPosition& outline, double bend, bool width_known,
                             const KalmanHeightParameters& parameters, LandingResult& result);

}  // namespace uav_landing
