#include "height/height_limit.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace uav_landing {

Failure tooUncertain(double height, double variance, const KalmanHeightParameters& parameters) {
  const double limit = std::max(parameters.min_height_error, parameters.max_height_error * height);
  const double bound = 3 * std::sqrt(variance);
  if (height > 0 && bound <= limit) return {};
  return {Reason::kUncertain, text("height ", rounded(height), " m has 3 sigma of ", rounded(bound),
                                   " m, more than ", rounded(limit), " m")};
}

}  // namespace uav_landing
