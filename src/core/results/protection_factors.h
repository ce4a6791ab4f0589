#pragma once

#include <algorithm>
#include <cmath>

#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/consistency_test.h"

namespace uav_landing {

/// Standard deviations that the terms of a protection level have (solution_separation.h).
struct ProtectionFactors {
  double healthy;  ///< while nothing is wrong
  double faulty;   ///< given that one source is wrong

  explicit ProtectionFactors(const KalmanHeightParameters& p)
      : healthy(normalQuantile(p.integrity_risk)),
        faulty(normalQuantile(std::min(1.0, p.integrity_risk / p.fault_probability))) {}

  /// Bound on the error of a value when the source is wrong that the solution with this variance does
  /// without.
  double bound(double value, double solution, double variance) const {
    return std::abs(value - solution) + faulty * std::sqrt(variance);
  }
};

}  // namespace uav_landing
