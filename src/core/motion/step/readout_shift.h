#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/matching/camera_motion.h"
#include "motion/matching/temporal_match.h"
#include "motion/matching/temporal_matching.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// A readout time that is not given but estimated. `times` is null when it is given.
struct ReadoutDoubt {
  const RowTimes* times = nullptr;  ///< row times of the left image for a readout of 1 s
  double time = 0;                  ///< current estimate, s
  /// Derivative of the ground normal now by the readout time, 1/s.
  Eigen::Vector3d normal_by_time = Eigen::Vector3d::Zero();
};

/// Sets by_readout of the matches. Then it moves the matches to where they would be with all rows exposed at
/// the stamps, according to the estimated time (s). The whole shift is applied to the place then. The effect
/// is linear in the readout time as long as that is much shorter than the step. Turns that are not even make
/// by_readout the mean effect up to this time, which is not quite the derivative.
///
/// over_ground: motion of the step, as far as it is known, with row times for a readout of 1 s. Call it again
/// when the motion is known better; it takes back its earlier shift first.
void shiftByReadout(const StereoRig& rig, const MotionOverGround& over_ground, double time,
                    std::vector<TemporalMatch>& matches);

}  // namespace uav_landing
