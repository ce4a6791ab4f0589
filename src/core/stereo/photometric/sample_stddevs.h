#pragma once

#include <Eigen/Core>
#include <vector>

#include "results/disparity_sample.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Makes the stddevs of samples true that come with those of the images' noise, by their residuals from the
/// plane g, 1/m: a factor, as pixels of rectified images are not independent, and an error that all samples
/// have besides, from the surface and the calibration. The factor shows in the noisier half of the samples,
/// the error in the quietest, which it concerns most: seen through more noise it is too uncertain.
/// Returns that error's variance, pixels^2. least_factor: 1 where neighbours have errors in common, so that
/// they scatter less than they are wrong, else 0. samples: at least one.
double makeStddevsTrue(const StereoRig& rig, const Eigen::Vector3d& g, double least_factor,
                       std::vector<DisparitySample>& samples);

}  // namespace uav_landing
