#pragma once

#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/kalman_height_parameters.h"

namespace uav_landing {

/// A failure when a height (m) with this variance (m^2) is too uncertain to be valid, or not above the
/// ground. Its 3 sigma must not exceed the larger of min_height_error and max_height_error times the height.
Failure tooUncertain(double height, double variance, const KalmanHeightParameters& parameters);

}  // namespace uav_landing
