#pragma once

#include "geometry/stamp_map.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Rows are exposed at different times, so disparities were carried to the stamp by a motion. This carries
/// the pair's ground again, by a better known motion: dg = A (rate(motion) - rate), where A and rate are
/// those of the stereo result. Nothing changes without row times.
///
/// When no readout time is given, readout has the estimated one, or 0 for a global shutter. A is then that of
/// a readout of 1 s, and nothing was carried before: dg = time A rate(motion). The covariances contain the
/// error of the time, and so does the share that all pairs have in common. Returns the derivative of g by the
/// readout time, 1/m/s; 0 when the time is given.
Eigen::Vector3d carryPlane(const RowMotion& motion, const ReadoutEstimate& readout,
                           StereoDepthResult& stereo);

/// The same with the step up to this pair; the covariance then contains the effect of the errors of its mean
/// rates. Without a step the rate counts as an error of its own size. Without a given readout time and
/// without a step, the rate of stereo is used instead.
void carryPlane(const ApproachAngleResult::Motion& step, const ReadoutEstimate& readout,
                StereoDepthResult& stereo);

/// The same by the rate of stereo alone. Nothing changes when the readout time is given.
Eigen::Vector3d carryPlane(const ReadoutEstimate& readout, StereoDepthResult& stereo);

}  // namespace uav_landing
