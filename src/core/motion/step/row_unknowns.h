#pragma once

#include <vector>

#include "geometry/stamp_map.h"
#include "motion/matching/temporal_match.h"
#include "motion/step/motion_rows.h"
#include "motion/step/motion_state.h"
#include "motion/step/row_shake.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"

namespace uav_landing {

/// Working memory of a fit: all matches, and a second problem for the three drawn ones or for another readout
/// time.
struct MotionMemory {
  MotionRows all, drawn;
  std::vector<TemporalMatch> shifted;
  ShakeShapes shapes;
};

/// Error of the delay of an inertial sensor that tells the turns between rows.
struct DelayDoubt {
  double variance = 0;  ///< s^2; 0: there is no such sensor
  GyroTurn then, now;   ///< in the frames of their images
  double readout = 0;   ///< time of all rows, s
};

/// What the matches say about that error.
struct DelayEffect {
  double information = 0;  ///< 1/s^2
  double score = 0;        ///< information times the error, 1/s
};

/// Possible errors of a motion, because rows are exposed one after the other.
struct RowDoubt {
  ShakeWatch shake;
  /// Derivative of the given normal by a readout time that is estimated, 1/s.
  Eigen::Vector3d normal_by_readout = Eigen::Vector3d::Zero();
  /// Covariance of a turn over a whole readout that nothing has accounted for, rad^2. It grows in proportion
  /// to the time of the row. The camera turns faster or slower than it was thought to.
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  DelayDoubt delay = {};
};

/// Additional unknowns of a motion, because rows are exposed one after the other.
struct RowUnknowns {
  bool has_time = false;   ///< whether a readout time is estimated, so that matches have by_readout
  SumsByTime by_time;      ///< sums of the readout time, reduced by turn, delay and shake
  Matrix9d information;    ///< information on the motion, reduced by turn, delay and shake
  Matrix9d without_shake;  ///< the same, not reduced by the shake
  DelayEffect delay;
  RowShake shake;
  Vector9d step = Vector9d::Zero();  ///< change of the motion to the one that fits best with all of them
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
