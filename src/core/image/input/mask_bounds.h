#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// The smallest rectangle that contains all pixels of a mono8 mask that are not 0; empty when there are none.
/// It does not read pixels that cannot enlarge it, as cv::boundingRect does. In OpenCV 4.6, that function
/// also misses columns of some parts of images.
cv::Rect boundsOf(const cv::Mat& mask);

}  // namespace uav_landing
