#pragma once

#include <optional>

#include "integrity/clock_watch.h"
#include "landing/height/height_track.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// The time between pairs: stamps that jump, and a clock that was set between two of them.
class LandingClock {
 public:
  /// reset_timeout: s, beyond which stamps have jumped ahead. gate: of heights, sigmas.
  LandingClock(double reset_timeout, double gate) : reset_timeout_(reset_timeout), gate_(gate) {}

  struct Time {
    double T = 0;  ///< s since the pair before; 0 after a jump and for the first pair
    Failure jump;  ///< everything has to start anew
  };
  Time follow(double stamp);
  /// Why everything has to start anew, if the clock was set since the pair before: the camera's way tells
  /// another time than the stamps, and so does the height of the pair alone. The clock itself goes on: its
  /// next step is to be noticed as well.
  Failure compare(const PairInput& in, const MeasuredHeight& pair, const HeightPrior& prior);
  /// s since the last pair; none before the first one.
  std::optional<double> since(double stamp) const;
  void reset();

 private:
  double reset_timeout_, gate_;
  std::optional<double> last_stamp_;  // s
  ClockWatch watch_;
};

}  // namespace uav_landing
