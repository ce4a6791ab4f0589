#pragma once

#include <vector>

#include "motion/matching/temporal_match.h"
#include "motion/step/motion_rows.h"
#include "motion/step/motion_state.h"
#include "motion/step/row_shake.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"

namespace uav_landing {

/// Possible errors of a motion, because rows are exposed one after the other.
struct RowDoubt {
  ShakeWatch shake;
  /// Derivative of the given normal by a readout time that is estimated, 1/s.
  Eigen::Vector3d normal_by_readout = Eigen::Vector3d::Zero();
};

/// Additional unknowns of a motion, because rows are exposed one after the other.
struct RowUnknowns {
  bool has_time = false;  ///< whether a readout time is estimated, so that matches have by_readout
  SumsByTime by_time;     ///< sums of the readout time, reduced by the shake
  RowShake shake;
};

/// State of a fit after its last iteration.
struct FittedRows {
  const MotionRows& rows;         ///< linearised at `linearised`
  const MotionState& linearised;  ///< state before the last step
  const Vector9d& step;           ///< from `linearised` to the result
  MotionUnknown motion;
  double factor;  ///< factor by which variances are larger than the rows claim
};

RowUnknowns findRowUnknowns(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                            const FittedRows& fitted, const RowDoubt& doubt, MotionMemory& memory);

}  // namespace uav_landing
