#pragma once

#include "integrity/recovery.h"
#include "landing/height/height_track.h"
#include "landing/watch/pair_monitor.h"

namespace uav_landing {

/// No height after contradictions before nothing has contradicted for recovery_time.
class RecoveryWait {
 public:
  explicit RecoveryWait(const KalmanHeightParameters& parameters)
      : max_age_(parameters.max_age),
        needed_(parameters.recovery_time),
        recovery_(parameters.recovery_time) {}

  /// Why the height is still waited for, if so. tests: all of the pair. T: s since the pair before.
  Failure follow(double T, const PairVerdict& pair, const PairTests& tests, const TrackVerdict& post);

 private:
  double max_age_, needed_;  // s
  Recovery recovery_;
};

}  // namespace uav_landing
