#pragma once

#include <memory>

#include "uav_landing/base/timings.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/parameters/rig_parameters.h"
#include "uav_landing/parameters/runway_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Post-processing for one pair (paper 3.2, 3.3): reconstruction, eqs (4) (5), height filter, eqs (6)-(8),
/// status and validity.
class KalmanHeightStage {
 public:
  KalmanHeightStage(const StereoRig& rig, const KalmanHeightParameters& parameters,
                    const RunwayParameters& runway = {}, const RigParameters& known_rig = {});
  KalmanHeightStage(const KalmanHeightStage& other);
  KalmanHeightStage& operator=(const KalmanHeightStage& other);
  ~KalmanHeightStage();
  KalmanHeightStage(KalmanHeightStage&&) noexcept;
  KalmanHeightStage& operator=(KalmanHeightStage&&) noexcept;

  /// stereo, approach: results of the same pair. The filter is reset (reason time_jump) when the stamp does
  /// not increase, or when it jumps ahead by more than reset_timeout. It is also reset when the clock was set
  /// in between.
  LandingResult process(const StereoDepthResult& stereo, const ApproachAngleResult& approach);
  /// Result when no pair came for max_age: the status is lost, and nothing is valid. stamp: the time now, s.
  LandingResult timeout(double stamp);
  /// Forgets everything except the count of resets.
  void reset();
  const Timings& timings() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace uav_landing
