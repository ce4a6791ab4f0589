#pragma once

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

// Results of one stage reach the next as messages, and anybody can publish those: with fields that were never
// filled in (zeros), with NaN, infinities, negative variances or sizes that no stage would give. A filter
// that takes one of them in may never recover. What comes out of checked() is safe to calculate with; a
// result of this package's own stages comes out as it went in.

/// A plane that cannot be used makes a failure, which names the field. Points outside the image or without a
/// positive stddev are left out, and a vertical rotation without a covariance becomes unknown.
StereoDepthResult checked(const StereoRig& rig, const StereoDepthResult& result);

/// Directions, normals, motions, angles and positions without a value that can be, or without a covariance,
/// become unknown; those of the runway get a failure. So do all numbers of a motion that failed, but for the
/// turn of a camera that hardly moves.
ApproachAngleResult checked(const ApproachAngleResult& result);

}  // namespace uav_landing
