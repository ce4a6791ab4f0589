#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Power of changes from row to row over the power of changes three quarters as fast. It is above 1 in images
/// whose rows belong to two fields or two colours, below 1 in others, as lenses blur, and 1 in noise. grey:
/// CV_8UC1.
double rowAlternation(const cv::Mat& grey);

}  // namespace uav_landing
