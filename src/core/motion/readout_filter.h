#pragma once

#include "motion/ego_motion.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Readout time of the cameras where none is given, from what it does to matches over time: one constant, by
/// Bayes from step to step. What a camera sees that hardly moves has no information and changes nothing.
class ReadoutFilter {
 public:
  /// 1 sigma before anything is known, s. Global shutters have 0, others 5 to 35 ms, either way.
  static constexpr double kPriorStddev = 0.02;

  /// effect: of a motion up to a pair, at the time estimated before. duration: since the pair before, s.
  void learn(const ReadoutEffect& effect, double duration);
  ReadoutEstimate estimate() const;

 private:
  double time_ = 0;
  double information_ = 1 / (kPriorStddev * kPriorStddev);
};

}  // namespace uav_landing
