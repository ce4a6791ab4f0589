#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Power of changes from row to row, over the power of changes that are three quarters as fast. grey:
/// CV_8UC1. The ratio is above 1 when the rows belong to two fields or two colours. It is below 1 in other
/// images, because lenses blur, and 1 in noise.
double rowAlternation(const cv::Mat& grey);

}  // namespace uav_landing
