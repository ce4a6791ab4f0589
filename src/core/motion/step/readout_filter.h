#pragma once

#include "motion/step/ego_motion.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Readout time of the cameras where none is given, from what it does to matches over time. There are two
/// hypotheses: a global shutter, with 0, and a rolling one, whose time is one constant, by Bayes from step to
/// step. What a camera sees that hardly moves has no information and changes nothing.
class ReadoutFilter {
 public:
  /// 1 sigma of a rolling shutter's time before anything is known, s: 5 to 35 ms, either way.
  static constexpr double kPriorStddev = 0.02;
  /// Probability of a global shutter then: less than the share of these, as a claim that is too narrow does
  /// more harm than one that is too wide.
  static constexpr double kGlobalBeforehand = 0.2;

  /// effect: of a motion up to a pair, corrected by the estimate before. duration: since the pair before, s.
  void learn(const ReadoutEffect& effect, double duration);
  /// The time by which to correct: 0 unless a global shutter is improbable, so that nothing is done to one
  /// by the estimate's noise. The variance is the mean square of what the true time may be off from it, by
  /// both hypotheses.
  ReadoutEstimate estimate() const;
  double globalProbability() const;

 private:
  double time_ = 0;  // of a rolling shutter
  double information_ = 1 / (kPriorStddev * kPriorStddev);
};

}  // namespace uav_landing
