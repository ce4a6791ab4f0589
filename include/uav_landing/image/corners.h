#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Harris corners spread over the image: the strongest of each cell first, at most count of them, with at
/// least min_distance pixels between two. image: mono8 or float; mask: mono8, corners only where it is not 0.
/// quality: weakest response kept as a share of the strongest. Integer pixel positions; sorted by row.
std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, int count, double quality,
                                   double min_distance, double harris_k);

}  // namespace uav_landing
