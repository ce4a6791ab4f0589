#pragma once

#include <cmath>
#include <vector>

#include "kernels/lanes/order_statistic.h"

namespace uav_landing {

/// The median; of an even number of values the upper one in the middle. There must be at least one.
inline double medianOf(const std::vector<double>& values) {
  return orderStatistic(values.data(), values.size(), values.size() / 2);
}

/// 1 sigma of normal errors over the median of their magnitudes.
constexpr double kPerMedian = 1.4826;
/// 1 sigma of normal errors from the median of their magnitudes.
inline double robustStddev(const std::vector<double>& magnitudes) {
  return kPerMedian * medianOf(magnitudes);
}

/// End of Tukey's biweight in robust standard deviations; residuals beyond it have no weight. (Beaton, Tukey:
/// The fitting of power series, meaning polynomials, Technometrics 16, 1974.)
struct TukeyEnd {
  /// 95 % as good as least squares when the errors are normal.
  static constexpr double kEfficient = 4.685;
  /// For matches over time, and for disparities. They are narrower, because many outliers are hardly farther
  /// off than noise: low objects on the ground, and corners at their edges.
  static constexpr double kTemporal = 4.5, kDisparity = 4.0;
};

/// Root of Tukey's biweight. ratio: residual over TukeyEnd times its standard deviation; 0 from 1 on.
inline double tukeyRoot(double ratio) { return std::abs(ratio) >= 1 ? 0 : 1 - ratio * ratio; }

}  // namespace uav_landing
