#pragma once

#include <algorithm>

#include "time_difference.h"

namespace uav_landing {

/// Lets at most this many messages per second pass, by their stamps. A message may come a quarter of a period
/// early, and the next ones make up for it. Otherwise jitter of the stamps would remove every second message
/// of a camera that is just as fast as allowed.
class RateLimit {
 public:
  /// rate: Hz. A stamp that is not after the last one that passed (the clock was set back) starts anew.
  bool passes(const ros::Time& stamp, double rate) {
    const double period = 1 / rate, slack = 0.25 * period;
    const bool begins = last_.isZero() || stamp <= last_;
    const double elapsed = begins ? 0 : secondsBetween(last_, stamp);
    if (begins) wait_ = 0;
    if (elapsed < wait_ - slack) return false;
    wait_ = std::max(wait_ - elapsed, -0.5 * period) + period;
    last_ = stamp;
    return true;
  }

 private:
  ros::Time last_;   // of the last message that passed
  double wait_ = 0;  // s, from then until the next one is due
};

}  // namespace uav_landing
