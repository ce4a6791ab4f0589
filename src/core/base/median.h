#pragma once

#include <vector>

#include "base/order_statistic.h"

namespace uav_landing {

/// The middle value, of an even number the upper one of two. At least one.
inline double medianOf(const std::vector<double>& values) {
  return orderStatistic(values.data(), values.size(), values.size() / 2);
}

/// 1 sigma of normal errors over the median of their magnitudes.
constexpr double kPerMedian = 1.4826;
/// 1 sigma of normal errors by the median of their magnitudes.
inline double robustStddev(const std::vector<double>& magnitudes) {
  return kPerMedian * medianOf(magnitudes);
}

}  // namespace uav_landing
