#pragma once

#include <ros/time.h>

#include <cstdint>

namespace uav_landing {

/// Seconds from then to now. (now - then).toSec() throws when the two are more than 68 years apart. Stamps of
/// other publishers may be.
inline double secondsBetween(const ros::Time& then, const ros::Time& now) {
  constexpr int64_t kSecond = 1000000000;
  int64_t seconds = static_cast<int64_t>(now.sec) - then.sec;
  int64_t nanoseconds = static_cast<int64_t>(now.nsec) - then.nsec;
  if (nanoseconds < 0) {
    nanoseconds += kSecond;
    --seconds;
  }
  return static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds);
}

}  // namespace uav_landing
