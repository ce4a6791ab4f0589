#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace uav_landing {

/// The middle value, of an even number the upper one of two. At least one; orders them anew.
inline double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// 1 sigma of normal errors over the median of their magnitudes.
constexpr double kPerMedian = 1.4826;
/// 1 sigma of normal errors by the median of their magnitudes.
inline double robustStddev(std::vector<double>& magnitudes) { return kPerMedian * medianOf(magnitudes); }

}  // namespace uav_landing
