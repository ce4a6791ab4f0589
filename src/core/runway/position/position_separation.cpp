#include "runway/position/position_separation.h"

#include <algorithm>
#include <cmath>

#include "uav_landing/results/consistency_test.h"

namespace uav_landing {

PositionSeparation::PositionSeparation(const KalmanHeightParameters& parameters)
    : factor_(normalQuantile(parameters.integrity_risk)),
      fault_factor_(normalQuantile(std::min(1.0, parameters.integrity_risk / parameters.fault_probability))) {
}

void PositionSeparation::predict(double movement, double stddev) {
  for (PositionAxis& axis : without_) axis.predict(movement, stddev);
}

void PositionSeparation::update(const CentreSolutions& seen, const Height& height, double seconds) {
  height_share_ = height.protection_level / height.value;
  for (int i = 0; i < kCentreSources; ++i) {
    const auto& [value, variance] = seen.without[i];
    if (!std::isfinite(value) || !(variance > 0)) continue;
    const double metric = variance * height.value * height.value + value * value * height.variance;
    without_[i].update(value * height.value, metric, 0, seconds);
  }
}

void PositionSeparation::forgetAbove(double stddev) {
  for (PositionAxis& axis : without_) axis.forgetAbove(stddev);
}

double PositionSeparation::protectionLevel(double y, double variance) const {
  const double stddev = std::sqrt(variance);
  if (!std::isfinite(height_share_)) return kUnknown;
  double level = std::max(factor_ * stddev, std::abs(y) * height_share_ + fault_factor_ * stddev);
  for (const PositionAxis& axis : without_) {
    if (!axis.known()) return kUnknown;
    level = std::max(level, std::abs(axis.value() - y) + fault_factor_ * std::sqrt(axis.variance()));
  }
  return level;
}

}  // namespace uav_landing
