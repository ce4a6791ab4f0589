#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// A maximum of an image's Harris response.
struct CornerCandidate {
  float response;  ///< > 0
  short x, y;
};

/// Memory that the search for corners works in, as there may be many candidates. Its contents mean nothing.
struct CornerMemory {
  std::vector<CornerCandidate> maxima, sorted;
};

/// Which Harris corners of an image to take.
struct CornerOptions {
  int count;            ///< largest number of corners
  double quality;       ///< weakest response kept, as a share of the strongest
  double min_distance;  ///< between two corners, pixels
  double harris_k;      ///< weight of the squared trace in the response
};

/// Harris corners spread over the image: the strongest of each cell first. image: mono8 or float. mask:
/// mono8, corners only where it is not 0. Positions are whole pixels, sorted by row.
std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, const CornerOptions& options,
                                   CornerMemory& memory);
/// The same with memory of its own.
std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, const CornerOptions& options);

/// Number of corners for an image: at most most, at least 20, and so many pixels_per_corner for each. When
/// windows overlap much, more corners cost time and tell little more.
int cornerBudget(const cv::Size& image, int most, int pixels_per_corner);

}  // namespace uav_landing
