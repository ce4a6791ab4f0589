#pragma once

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

// Results of one stage reach the next one as messages, and anybody can publish those. Fields may never have
// been filled in (zeros). They may be NaN, infinite, negative variances, or sizes that no stage would give. A
// filter that uses one of them may never recover. The output of checked() is safe to calculate with. A result
// of this package's own stages does not change.

/// When the plane cannot be used, the result gets a failure that names the field. Points outside the image or
/// without a positive stddev are removed. A vertical rotation without a covariance becomes unknown.
StereoDepthResult checked(const StereoRig& rig, const StereoDepthResult& result);

/// Directions, normals, motions, angles and positions become unknown when their value is not possible, or
/// when they have no covariance. Those of the runway also get a failure. All numbers of a failed motion
/// become unknown, except the rotation of a camera that hardly moves.
ApproachAngleResult checked(const ApproachAngleResult& result);

}  // namespace uav_landing
