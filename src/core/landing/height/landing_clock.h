#pragma once

#include <optional>

#include "integrity/tests/clock_watch.h"
#include "landing/height/height_track.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// Time between pairs. It detects stamps that jump, and a clock that was set between two pairs.
class LandingClock {
 public:
  /// reset_timeout: longest time between pairs, s; beyond it the stamps have jumped. gate: for heights, in
  /// standard deviations.
  LandingClock(double reset_timeout, double gate) : reset_timeout_(reset_timeout), gate_(gate) {}

  struct Time {
    double T = 0;  ///< s since the previous pair; 0 after a jump and for the first pair
    Failure jump;  ///< set when everything has to start again
  };
  Time follow(double stamp);
  /// Detects that the clock was set since the previous pair. Then everything has to start again, and the
  /// failure says why. The distance that the camera moved must fit another time than the stamps, and so must
  /// the height of this pair. The watch itself goes on, so that it notices the next setting as well.
  Failure compare(const PairInput& in, const MeasuredHeight& pair, const HeightPrior& prior);
  /// s since the last pair; nothing before the first one.
  std::optional<double> since(double stamp) const;
  void reset();

 private:
  double reset_timeout_, gate_;
  std::optional<double> last_stamp_;  // s
  ClockWatch watch_;
};

}  // namespace uav_landing
