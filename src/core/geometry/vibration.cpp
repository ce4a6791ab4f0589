#include "geometry/vibration.h"

#include <cmath>

namespace uav_landing {

double Vibration::alike(double apart) const {
  constexpr double kAlike = 0.5;  // cycles, so the frequency is known to a third
  const double cycles_apart = apart * cycles;
  return std::cos(2 * M_PI * cycles_apart) * std::exp(-0.5 * std::pow(cycles_apart / kAlike, 2));
}

}  // namespace uav_landing
