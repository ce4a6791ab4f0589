#pragma once

#include "geometry/stamp_map.h"
#include "geometry/vibration.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Turns between the rows of an image, beyond the mean rate.
struct TurnsBetweenRows {
  GyroTurn measured;    ///< by an inertial sensor
  Vibration vibration;  ///< that nothing measured
};

/// What they do to the plane of stereo, by its points: a plane is fitted to what they add to the disparities.
/// Points stand for all pixels that made the plane, so a part of what was measured stays as uncertainty.
/// times: of the rows.
ApproachAngleResult::PlaneByTurns planeByTurns(const StereoRig& rig, const RowTimes& times,
                                               const TurnsBetweenRows& turns,
                                               const StereoDepthResult& stereo);

/// Takes that off the plane. What is too large for vibration widens the covariance instead. Vibration may
/// keep its phase from pair to pair, so the covariance counts as one that all pairs have in common. Returns
/// what it adds to the covariance, 1/m^2.
Eigen::Matrix3d takeOff(const ApproachAngleResult::PlaneByTurns& by_turns, StereoDepthResult& stereo);

}  // namespace uav_landing
