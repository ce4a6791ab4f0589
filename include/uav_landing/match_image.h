#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// An image prepared for matching: lightly smoothed (so that interpolation does not pull matches towards
/// whole pixels) in float, at full size and at a coarse level of about 400 columns for wide searches.
struct MatchImage {
  cv::Mat fine;    ///< CV_32F, full size
  cv::Mat coarse;  ///< CV_32F, averaged over factor x factor pixels
  int factor = 1;

  /// image: mono8.
  void assign(const cv::Mat& image);
};

/// Reduction of the coarse level for images of this size: 1, 2, 4, ...
int coarseFactor(const cv::Size& size);

/// Coordinate of a full-size pixel at the coarse level, and back (pixel centres are whole numbers).
inline double toCoarse(double x, int factor) { return (x + 0.5) / factor - 0.5; }
inline double fromCoarse(double x, int factor) { return (x + 0.5) * factor - 0.5; }

}  // namespace uav_landing
