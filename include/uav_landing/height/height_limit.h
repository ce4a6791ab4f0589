#pragma once

#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/kalman_height_parameters.h"

namespace uav_landing {

/// Why a height (m, m^2) is too uncertain to be valid: 3 sigma above max_height_error of it and
/// min_height_error, or not above the ground. None where it is not.
Failure tooUncertain(double height, double variance, const KalmanHeightParameters& parameters);

}  // namespace uav_landing
