#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Smooths by a 3 x 3 Gaussian of 0.7 px, mirrored at the borders' pixels. image: mono8 or float; at least 2
/// x 2. smoothed: float, another image.
void smooth(const cv::Mat& image, cv::Mat& smoothed);

/// Mean over blocks of factor x factor pixels; what is left over on the right and below is not seen. image:
/// mono8. reduced: float. factor: up to 256.
void reduce(const cv::Mat& image, int factor, cv::Mat& reduced);

}  // namespace uav_landing
