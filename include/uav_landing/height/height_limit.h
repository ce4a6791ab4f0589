#pragma once

#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/kalman_height_parameters.h"

namespace uav_landing {

/// Tells when a height (m, m^2) is too uncertain to be valid: its 3 sigma exceed the larger of
/// min_height_error and max_height_error times the height, or it is not above the ground. No failure
/// otherwise.
Failure tooUncertain(double height, double variance, const KalmanHeightParameters& parameters);

}  // namespace uav_landing
