#pragma once

#include <vector>

#include "motion/matching/temporal_match.h"
#include "motion/step/motion_rows.h"
#include "motion/step/motion_state.h"
#include "motion/step/row_shake.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"

namespace uav_landing {

/// What rows that are exposed one after the other do to a motion.
struct RowDoubt {
  const RowTimes* times = nullptr;  ///< of rows that may shake; null: all are exposed at once
  ShakeMemory* shake = nullptr;
  /// How the normal given follows a readout time that is not given, 1/s.
  Eigen::Vector3d normal_by_readout = Eigen::Vector3d::Zero();
};

/// What rows that are exposed one after the other leave open beside a motion.
struct RowUnknowns {
  bool has_time = false;  ///< a readout time is estimated: matches have by_readout
  SumsByTime by_time;     ///< of the time, less what the shake hides
  RowShake shake;
};

/// A motion as its iterations end.
struct FittedRows {
  const MotionRows& rows;         ///< linearised there
  const MotionState& linearised;  ///< where that is
  const Vector9d& step;           ///< from there to the motion
  const Matrix9d& information;    ///< on the motion, with priors
  double factor;                  ///< by which variances are larger than rows say
};

RowUnknowns findRowUnknowns(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                            const FittedRows& fitted, const RowDoubt& doubt, MotionMemory& memory);

}  // namespace uav_landing
