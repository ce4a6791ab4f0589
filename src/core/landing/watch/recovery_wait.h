#pragma once

#include "integrity/tests/recovery.h"
#include "landing/height/height_track.h"
#include "landing/watch/pair_monitor.h"

namespace uav_landing {

/// After contradictions, the height is not valid until nothing has contradicted it for recovery_time.
class RecoveryWait {
 public:
  explicit RecoveryWait(const KalmanHeightParameters& parameters)
      : max_age_(parameters.max_age),
        needed_(parameters.recovery_time),
        recovery_(parameters.recovery_time) {}

  /// Returns a failure while the height has to wait. T: s since the previous pair. tests: all tests of the
  /// pair.
  Failure follow(double T, const PairVerdict& pair, const PairTests& tests, const TrackVerdict& post);

 private:
  double max_age_, needed_;  // s
  Recovery recovery_;
};

}  // namespace uav_landing
