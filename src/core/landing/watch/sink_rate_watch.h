#pragma once

#include "integrity/memory/height_memory.h"
#include "integrity/tests/pair_tests.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// Tests the published height against an earlier one, carried on by the motion. The motion needs no stereo.
class SinkRateWatch {
 public:
  explicit SinkRateWatch(const KalmanHeightParameters& parameters) : parameters_(parameters) {}

  /// The published height.
  struct Published {
    const HeightFilter& filter;
    const HeightErrors& errors;  ///< of the pair's height, for those that the filter does not know
  };
  /// Returns why the published height is not valid, if so. doubt: of the pair's step. tests: those made so
  /// far; sink_rate is added.
  Failure check(const PairInput& in, const Ground& ground, const Published& published,
                const MotionDoubt& doubt, PairTests& tests);

 private:
  void carry(const PairInput& in, const Ground& ground, double scale, const MotionDoubt& doubt,
             bool level_known);

  KalmanHeightParameters parameters_;
  HeightMemory memory_;
};

}  // namespace uav_landing
