#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Where the Harris response of an image has a maximum.
struct CornerCandidate {
  float response;  ///< > 0
  short x, y;
};

/// Memory that corners are looked for in: there may be many candidates. The contents mean nothing.
struct CornerMemory {
  std::vector<CornerCandidate> maxima, sorted;
};

/// Harris corners spread over the image: the strongest of each cell first, at most count of them, with at
/// least min_distance pixels between two. image: mono8 or float; mask: mono8, corners only where it is not 0.
/// quality: weakest response kept as a share of the strongest. Integer pixel positions; sorted by row.
std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, int count, double quality,
                                   double min_distance, double harris_k, CornerMemory& memory);
/// The same with memory of its own.
std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, int count, double quality,
                                   double min_distance, double harris_k);

/// How many corners, most at most, are looked for in an image where each has so many pixels of it at least:
/// where windows overlap much, more corners cost time and tell little more. Twenty in any case.
int cornerBudget(const cv::Size& image, int most, int pixels_per_corner);

}  // namespace uav_landing
