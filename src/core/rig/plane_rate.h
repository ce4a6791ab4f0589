#pragma once

#include "geometry/stamp_map.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A pair's ground at the stamp by a better known motion than the one that its disparities were carried with:
/// dg = A (rate(motion) - rate), with A and rate of the stereo result. Nothing changes without row times.
void carryPlane(const RowMotion& motion, StereoDepthResult& stereo);

/// The same by the step up to this pair, with what its errors do to the plane in the covariance. Without a
/// step the rate is as uncertain as it is large.
void carryPlane(const ApproachAngleResult::Motion& step, StereoDepthResult& stereo);

}  // namespace uav_landing
