#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Some rows of an image smoothed by a 3 x 3 Gaussian of 0.7 px, mirrored at the image's outermost pixels.
/// image: mono8, at least 2 x 2. smoothed: float, of the same size; its other rows stay as they are.
void smooth(const cv::Mat& image, const cv::Range& rows, cv::Mat& smoothed);

/// The same of an image made smaller: each pixel the mean over factor x factor ones; what is left over on the
/// right and below is not seen. image: mono8. factor: up to 256. smoothed: float, of the smaller size. rows:
/// of that.
void smoothReduced(const cv::Mat& image, int factor, const cv::Range& rows, cv::Mat& smoothed);

}  // namespace uav_landing
