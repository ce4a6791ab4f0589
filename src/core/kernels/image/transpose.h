#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// The columns of a mono8 image as rows. transposed: already has that size.
void transpose(const cv::Mat& image, cv::Mat& transposed);

}  // namespace uav_landing
