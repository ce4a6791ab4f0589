#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Smooths some rows of an image by a 3 x 3 Gaussian of 0.7 px, mirrored at the outermost pixels. image:
/// mono8, at least 2 x 2. smoothed: float, of the same size; its other rows stay as they are.
void smooth(const cv::Mat& image, const cv::Range& rows, cv::Mat& smoothed);

/// The same for a reduced image, whose pixels are means over factor x factor pixels. A remainder on the right
/// and below is dropped. image: mono8. factor: up to 256. smoothed: float, of the reduced size. rows: of the
/// reduced image.
void smoothReduced(const cv::Mat& image, int factor, const cv::Range& rows, cv::Mat& smoothed);

}  // namespace uav_landing
