#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// The smallest rectangle that holds all pixels of a mono8 mask that are not 0, without a look at those that
/// cannot make it larger. Empty when there are none. (cv::boundingRect looks at all of them, and that of
/// OpenCV 4.6 misses columns of some parts of images.)
cv::Rect boundsOf(const cv::Mat& mask);

}  // namespace uav_landing
