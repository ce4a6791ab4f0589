#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/matching/camera_motion.h"
#include "motion/matching/temporal_match.h"
#include "motion/matching/temporal_matching.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// A readout time that is not given. Without times there is no doubt.
struct ReadoutDoubt {
  const RowTimes* times = nullptr;                           ///< of the left image's rows at a readout of 1 s
  double time = 0;                                           ///< as it is estimated, s
  Eigen::Vector3d normal_by_time = Eigen::Vector3d::Zero();  ///< of the ground's normal now, 1/s
};

/// The times of rows that are, or may be, exposed one after the other: as they are given, or else those of
/// the doubt. Null where they are exposed at once.
const RowTimes* rollingRows(const RowTimes* given, const ReadoutDoubt& doubt);

/// Sets by_readout of matches, and carries them to the stamps by the estimated time: all of it goes into the
/// place then. The effect is linear for times much shorter than the step. unit: of a readout of 1 s. motion:
/// of the step, as far as it is known: matches shifted before by one that is less well known are shifted
/// anew.
void shiftByReadout(const StereoRig& rig, const RowsOverTime& unit, const CameraMotion& motion,
                    const Eigen::Vector3d& normal, double time, std::vector<TemporalMatch>& matches);

}  // namespace uav_landing
