#pragma once

#include "geometry/stamp_map.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A pair's ground at the stamp by a better known motion than the one that its disparities were carried with:
/// dg = A (rate(motion) - rate), with A and rate of the stereo result. Nothing changes without row times.
///
/// Where the readout time is estimated, as none is given, A is that of a readout of 1 s and nothing was
/// carried: dg = time A rate(motion), and what the error of the time does is in the covariances, in the share
/// that all pairs have in common, too. Returns dg by that time, 1/m/s, or 0.
Eigen::Vector3d carryPlane(const RowMotion& motion, const ReadoutEstimate& readout,
                           StereoDepthResult& stereo);

/// The same by the step up to this pair, with what its errors do to the plane in the covariance. Without a
/// step the rate is as uncertain as it is large; by an estimated readout time it is that of stereo.
void carryPlane(const ApproachAngleResult::Motion& step, const ReadoutEstimate& readout,
                StereoDepthResult& stereo);

/// By an estimated readout time and the rate of stereo alone.
Eigen::Vector3d carryPlane(const ReadoutEstimate& readout, StereoDepthResult& stereo);

}  // namespace uav_landing
