#pragma once

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Variance of the third component of a plane vector g (1/m^2) by a disparity error common to all pixels.
/// bias_stddev: 1 sigma of this error, pixels.
inline double biasVariance(const StereoRig& rig, double bias_stddev) {
  const double of_g = bias_stddev / rig.fb();
  return of_g * of_g;
}

}  // namespace uav_landing
