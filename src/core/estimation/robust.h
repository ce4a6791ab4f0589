#pragma once

#include <cmath>
#include <vector>

#include "kernels/lanes/order_statistic.h"

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

/// Where Tukey's biweight ends, in robust standard deviations: what is farther off has no weight. (Beaton,
/// Tukey: The fitting of power series, meaning polynomials, Technometrics 16, 1974.)
struct TukeyEnd {
  /// 95 % as good as least squares when the errors are normal.
  static constexpr double kEfficient = 4.685;
  /// Of matches over time, and of disparities: a little narrower, as many outliers are hardly farther off
  /// than noise: what stands low above the ground, corners at its edges.
  static constexpr double kTemporal = 4.5, kDisparity = 4.0;
};

/// Root of Tukey's biweight of a residual over TukeyEnd times its standard deviation; 0 beyond 1.
inline double tukeyRoot(double ratio) { return std::abs(ratio) >= 1 ? 0 : 1 - ratio * ratio; }

}  // namespace uav_landing
