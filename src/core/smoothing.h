#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Smooths by a 3 x 3 Gaussian of 0.7 px, mirrored at the borders' pixels. image: mono8, at least 2 x 2.
/// smoothed: float.
void smooth(const cv::Mat& image, cv::Mat& smoothed);

/// The same of an image made smaller: each pixel the mean over factor x factor ones; what is left over on the
/// right and below is not seen. image: mono8. factor: up to 256.
void smoothReduced(const cv::Mat& image, int factor, cv::Mat& smoothed);

}  // namespace uav_landing
