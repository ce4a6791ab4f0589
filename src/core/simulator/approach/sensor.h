#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Turns light into the delivered image: lens blur, gain and offset, noise, rounding to 8 bits. grey: 32-bit
/// float, overwritten. seed: for the noise of this image.
void expose(const SimulatedImageParameters& image, const SimulatedCameraParameters& camera, uint64_t seed,
            cv::Mat& grey, cv::Mat& mono8);

}  // namespace uav_landing
