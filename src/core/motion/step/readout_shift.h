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
};

/// Sets by_readout of the matches. Then it moves the matches to where they would be with all rows exposed at
/// the stamps, according to the estimated time (s). The whole shift is applied to the place then. The effect
/// is linear in the readout time as long as that is much shorter than the step. Where the camera turns faster
/// and faster, by_readout is the mean effect up to this time. That is not quite the derivative.
///
/// over_ground: motion of the step, as far as it is known. Its row times are for a readout of 1 s. Call it
/// again when the motion is known better. It takes back its earlier shift first.
void shiftByReadout(const StereoRig& rig, const MotionOverGround& over_ground, double time,
                    std::vector<TemporalMatch>& matches);

}  // namespace uav_landing
