#pragma once

#include <sstream>
#include <string>

namespace uav_landing {

/// The arguments one after another as text, numbers with six significant digits.
template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

/// A measured number as reasons show it: four significant digits, as the rest is noise.
inline std::string rounded(double value) {
  std::ostringstream out;
  out.precision(4);
  out << value;
  return out.str();
}

}  // namespace uav_landing
