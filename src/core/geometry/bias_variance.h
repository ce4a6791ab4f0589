#pragma once

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Variance of the third component of a plane vector g by a disparity error that all pixels have in common,
/// 1/m^2. bias_stddev: 1 sigma of it, pixels.
inline double biasVariance(const StereoRig& rig, double bias_stddev) {
  const double of_g = bias_stddev / rig.fb();
  return of_g * of_g;
}

}  // namespace uav_landing
