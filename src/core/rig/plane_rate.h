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

/// The same with the step up to this pair; the covariance then contains the effect of the step's errors.
/// Without a step the rate counts as an error of its own size. Without a given readout time and without a
/// step, the rate of stereo is used instead.
void carryPlane(const ApproachAngleResult::Motion& step, const ReadoutEstimate& readout,
                StereoDepthResult& stereo);

/// What turns beyond the mean rate do to the plane of stereo, 1/m, by its points: a plane is fitted to what
/// they add to the disparities. times: of the rows.
Eigen::Vector3d planeByTurns(const StereoRig& rig, const RowTimes& times, const GyroTurn& turns,
                             const StereoDepthResult& stereo);

/// Takes that off the plane. Points stand for all pixels that made the plane, so a part of it stays as
/// uncertainty. All of it does where it is too large for vibration.
void takeOff(const Eigen::Vector3d& by_turns, StereoDepthResult& stereo);

/// The same by the rate of stereo alone. Nothing changes when the readout time is given.
Eigen::Vector3d carryPlane(const ReadoutEstimate& readout, StereoDepthResult& stereo);

}  // namespace uav_landing
