#pragma once

#include "uav_landing/height_filter.h"
#include "uav_landing/parameters.h"
#include "uav_landing/stage_results.h"
#include "uav_landing/timings.h"

namespace uav_landing {

/// Post-processing for one pair (paper 3.2, 3.3): reconstruction, eqs (4) (5), height filter, eqs (6)-(8),
/// status and validity.
class KalmanHeightStage {
 public:
  KalmanHeightStage(const StereoRig& rig, const KalmanHeightParameters& parameters);

  /// Results of the same pair. A stamp that does not increase resets the filter (reason time_jump).
  LandingResult process(const StereoDepthResult& stereo, const ApproachAngleResult& approach);
  /// What to say when no pair came for max_age: status lost, nothing valid. stamp: of now, s.
  LandingResult timeout(double stamp);
  void reset();
  const Timings& timings() const { return timings_; }

 private:
  StereoRig rig_;
  KalmanHeightParameters parameters_;
  HeightFilter filter_;
  Timings timings_;
};

}  // namespace uav_landing
