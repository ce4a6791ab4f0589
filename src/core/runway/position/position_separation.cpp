#include "runway/position/position_separation.h"

#include <algorithm>
#include <cmath>

#include "estimation/limits.h"

namespace uav_landing {
namespace {

constexpr Sigmas kContradicts(5);

}  // namespace

PositionSeparation::PositionSeparation(const KalmanHeightParameters& parameters) : factors_(parameters) {}

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

bool PositionSeparation::contradicts(double y, double matters) const {
  return std::any_of(without_.begin(), without_.end(), [&](const PositionAxis& axis) {
    return axis.known() &&
           std::abs(y - axis.value()) > std::max(matters, kContradicts.bound(axis.variance()));
  });
}

double PositionSeparation::protectionLevel(double y, double variance) const {
  const double stddev = std::sqrt(variance);
  if (!std::isfinite(height_share_)) return kUnknown;
  double level = std::max(factors_.healthy * stddev, std::abs(y) * height_share_ + factors_.faulty * stddev);
  for (const PositionAxis& axis : without_) {
    if (!axis.known()) return kUnknown;
    level = std::max(level, factors_.bound(y, axis.value(), axis.variance()));
  }
  return level;
}

}  // namespace uav_landing
