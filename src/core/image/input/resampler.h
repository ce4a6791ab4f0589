#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "kernels/image/bilinear_rows.h"

namespace uav_landing {

/// Bilinear interpolation in fixed point, at places that are the same for each image. It is several times as
/// fast as cv::remap, and gives the same bits on every processor.
class Resampler {
 public:
  /// map1, map2: source of each pixel, in 1/32 px, as cv::convertMaps makes them (CV_16SC2, CV_16UC1). mask:
  /// mono8; the result is 0 where it is 0. Elsewhere all pixels with a weight must lie in an image of the
  /// size `source`, so the mask is empty for one with fewer than two rows or columns.
  Resampler(const cv::Mat& map1, const cv::Mat& map2, const cv::Mat& mask, cv::Size source);

  /// raw: mono8 of the size given. out: mono8 of the mask's size; its memory is reused.
  void resample(const cv::Mat& raw, cv::Mat& out) const;

 private:
  /// The window of the half that begins at this pixel; false when its sources do not fit into one.
  bool findWindow(int u, int v, cv::Size source, SourceWindows& windows, int half) const;
  void findWindows(cv::Size source);
  void resampleRun(const cv::Mat& raw, const cv::Point& first, int count, cv::Mat& out) const;

  cv::Mat places_, weights_, mask_;  // weights in 1/32: of the right pixels in the lower byte, of the lower
                                     // pixels in the upper one
  size_t windows_per_row_ = 0;
  std::vector<SourceWindows> windows_;  // empty when the processor has no use for them
  std::vector<cv::Point> apart_;        // first pixels of the halves without a window
};

}  // namespace uav_landing
