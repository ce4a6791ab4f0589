#pragma once

#include "motion/step/ego_motion.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Estimates the readout time of the cameras from its effect on matches over time, when no time is given.
/// There are two hypotheses: a global shutter, whose time is 0, and a rolling shutter, whose time is an
/// unknown constant. Bayes' rule updates them with each step. A camera that hardly moves gives no
/// information, so the estimate stays as it is.
class ReadoutFilter {
 public:
  /// 1 sigma of a rolling shutter's time before any measurement, s. It covers 5 to 35 ms in both directions.
  static constexpr double kPriorStddev = 0.02;
  /// Probability of a global shutter when nothing is known. Global shutters are more frequent than this. A
  /// low value is safer, because too narrow a claim does more harm than too wide a one.
  static constexpr double kGlobalBeforehand = 0.2;

  /// Probability of a global shutter after rows were seen to move on their own. Ground that is no plane can
  /// look like that.
  static constexpr double kGlobalAfterSign = 0.01;

  /// global_beforehand: probability of a global shutter before any measurement.
  explicit ReadoutFilter(double global_beforehand = kGlobalBeforehand)
      : global_beforehand_(global_beforehand) {}

  /// effect: of a motion up to this pair, which was corrected with the estimate so far. duration: time since
  /// the previous pair, s.
  void learn(const ReadoutEffect& effect, double duration);
  /// Readout time to correct with. It is 0 unless a global shutter is improbable, so that noise of the
  /// estimate does not disturb images of a global shutter. The variance is the mean squared difference from
  /// the true time over both hypotheses.
  ReadoutEstimate estimate() const;
  double globalProbability() const;

 private:
  double global_beforehand_;
  double time_ = 0;  // of the hypothesis "rolling shutter", s
  double information_ = 1 / (kPriorStddev * kPriorStddev);
};

}  // namespace uav_landing
