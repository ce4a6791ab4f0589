#pragma once

#include <optional>
#include <string>

#include "integrity/memory/speed_memory.h"
#include "integrity/tests/pair_tests.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"
#include "landing/watch/velocity_watch.h"
#include "rig/rig_change.h"

namespace uav_landing {

/// Result of the tests of a pair.
struct PairVerdict {
  explicit PairVerdict(const PairTests& none) : tests(none) {}

  PairTests tests;             ///< tests of the phases "ground" and "pair"
  Failure failure;             ///< why a pair that has a height is rejected
  bool angle_refused = false;  ///< whether angles from this pair must not be used either
  /// The pair passed its tests, but is rejected because previous pairs failed.
  bool confirming = false;
  bool rig_believed = true;               ///< whether the rig may be learned from this pair
  std::optional<RigRotation> rig_turned;  ///< new rotation of the rig, valid from now on
  VelocityWatch::Verdict velocity;

  bool leftOut() const { return static_cast<bool>(failure); }
  /// Whether the sources agree on the vertical direction of the motion, and its rows do not move on their
  /// own.
  bool knowsDown() const {
    return !tests.failed(IntegrityTest::kVanishingPoint) && !tests.failed(IntegrityTest::kMotionNormal) &&
           !tests.failed(IntegrityTest::kRowMotion);
  }
};

/// Tests the sources of a pair against each other and against the previous pairs. What a failed test does is
/// stated in the catalogue (integrity/tests/test_catalogue.h): mostly, the pair gives no height.
class PairMonitor {
 public:
  PairMonitor(const StereoRig& rig, const KalmanHeightParameters& parameters);

  /// Whether the vertical disparities of a pair must not be used for the rig. Call it before check().
  bool doubtsRig(const RigRotation& measured) const { return rig_change_.doubts(measured); }
  /// duration_variance: of durations between stamps, divided by their squares.
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
  // Pairs that failed, and pairs that passed since; each at most kConfirmations.
  int failed_ = 0, passed_ = 0;
};

}  // namespace uav_landing
