#pragma once

#include <optional>
#include <string>

#include "integrity/pair_tests.h"
#include "integrity/speed_memory.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"
#include "landing/watch/velocity_watch.h"
#include "rig/rig_change.h"

namespace uav_landing {

/// What the tests say of a pair.
struct PairVerdict {
  explicit PairVerdict(const PairTests& none) : tests(none) {}

  PairTests tests;             ///< of the steps ground and pair
  Failure failure;             ///< why a pair that has a height is left out
  bool angle_refused = false;  ///< no angle that is made of this pair is believed either
  /// The pair passed, but has been left out for those before it that failed.
  bool confirming = false;
  bool rig_believed = true;               ///< what the pair says of the rig may be learned
  std::optional<RigRotation> rig_turned;  ///< another rotation than before, the rig's from now on
  VelocityWatch::Verdict velocity;

  bool leftOut() const { return static_cast<bool>(failure); }
  /// The sources agree on which part of the motion was downwards.
  bool knowsDown() const {
    return !tests.failed(IntegrityTest::kVanishingPoint) && !tests.failed(IntegrityTest::kMotionNormal);
  }
};

/// Tests the sources of a pair against each other and against the pairs before. A failed test makes the pair
/// give no height, as its line in the catalogue says (integrity/test_catalogue.h).
class PairMonitor {
 public:
  PairMonitor(const StereoRig& rig, const KalmanHeightParameters& parameters);

  /// Whether the vertical disparities of a pair say nothing of the rig. Before check().
  bool doubtsRig(const RigRotation& measured) const { return rig_change_.doubts(measured); }
  /// duration_variance: of durations between stamps, over their squares.
  PairVerdict check(const PairInput& in, const Ground& ground, const MeasuredHeight& measured,
                    const HeightPrior& prior, double duration_variance);

 private:
  void testRig(const PairInput& in, PairVerdict& verdict);
  void testBaseline(const PairInput& in, PairTests& tests) const;
  void testStandstill(const PairInput& in, double height, PairTests& tests);
  std::string problemOf(const std::optional<IntegrityTest>& failed);

  StereoRig rig_;
  KalmanHeightParameters parameters_;
  RigChange rig_change_;
  SpeedMemory speed_;
  VelocityWatch velocity_;
  int failed_ = 0, passed_ = 0;  // pairs: failures before and passes since, up to three
};

}  // namespace uav_landing
