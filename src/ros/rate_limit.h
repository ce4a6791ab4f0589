#pragma once

#include <algorithm>

#include "time_difference.h"

namespace uav_landing {

/// Lets at most so many messages a second pass, by their stamps. A message may come a quarter of a period
/// early, which the next ones make up for: stamps of a camera jitter, and of those that come just as fast as
/// allowed every second one would be left out.
class RateLimit {
 public:
  /// rate: Hz. A stamp that is not after the last one that passed (the clock was set back) begins anew.
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
  ros::Time last_;   // that passed
  double wait_ = 0;  // s, from there to when the next one is due
};

}  // namespace uav_landing
