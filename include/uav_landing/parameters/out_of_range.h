#pragma once

#include <sstream>
#include <string>

namespace uav_landing {

/// What is wrong with a number that is not in the range of its parameter (or NaN), behind its name.
template <class Number>
std::string outOfRange(Number given, double min, double max, const char* unit) {
  std::ostringstream text;
  text << given << " is out of range, expected " << min << " to " << max << (*unit == '\0' ? "" : " ")
       << unit;
  return text.str();
}

}  // namespace uav_landing
