#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Power of what changes from row to row over the power of what changes three quarters as fast. Above 1 in
/// pictures whose rows are of two fields or two colours; below 1 in others, as lenses blur; 1 in noise.
/// grey: CV_8UC1.
double rowAlternation(const cv::Mat& grey);

}  // namespace uav_landing
