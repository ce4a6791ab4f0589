#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/plane_vector.h"
#include "results/disparity_sample.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Makes the stddevs of samples true; they come with the noise of the images only. Their residuals from the
/// plane g (1/m) tell two corrections. One is a factor, as pixels of rectified images are not independent;
/// the noisier half of the samples shows it. The other is an error of surface and calibration that all
/// samples have. It shows in the quietest samples, which it concerns most, as more noise would hide it.
/// Returns the variance of that error, pixels^2. least_factor: 1 when neighbours have errors in common, so
/// that they scatter less than they are wrong; else 0. samples: at least one.
double makeStddevsTrue(const StereoRig& rig, const PlaneVector& g, double least_factor,
                       std::vector<DisparitySample>& samples);

}  // namespace uav_landing
