#pragma once

#include <sstream>
#include <string>

namespace uav_landing {

/// Text that follows a parameter's name when its number is out of range or NaN.
template <class Number>
std::string outOfRange(Number given, double min, double max, const char* unit) {
  std::ostringstream text;
  text << given << " is out of range, expected " << min << " to " << max << (*unit == '\0' ? "" : " ")
       << unit;
  return text.str();
}

}  // namespace uav_landing
