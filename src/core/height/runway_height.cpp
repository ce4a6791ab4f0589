#include "height/runway_height.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// 1 sigma by which the ground before a runway slopes against it, rad.
constexpr double kSlope = 0.5 * M_PI / 180;
constexpr double kAgreement = 5;  // sigma

}  // namespace

RunwayHeight runwayHeight(const LandingResult& landing, double bend, bool width_known) {
  if (!landing.height_valid || !std::isfinite(landing.x)) return {};
  const double before = std::max(0.0, std::sqrt(landing.x_variance) - landing.x);
  const double height = landing.height - bend;
  const double variance = landing.height_variance + std::pow(kSlope * before, 2);
  if (!width_known || !std::isfinite(landing.width_height) || !(landing.width_height_variance > 0))
    return {height, variance};
  const double by_width = landing.width_height - bend, of_width = landing.width_height_variance;
  const double difference = by_width - height, sum = variance + of_width;
  if (difference * difference > kAgreement * kAgreement * sum) return {};
  return {height + variance / sum * difference, variance * of_width / sum};
}

}  // namespace uav_landing
