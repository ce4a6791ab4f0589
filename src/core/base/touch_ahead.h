#pragma once

#include <algorithm>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Reads the surroundings of a place of a float image that are worked on soon, and forgets what it read.
/// Windows of corners lie anywhere in images that are larger than the caches near the processor: read here,
/// their rows are waited for all at once, while the work on another corner goes on; read by the work itself,
/// one after the other. A prefetch instruction would not do: it comes to nothing where the address of the
/// page is not at hand either, as is usual here. across, down: pixels to each side; what is outside the image
/// is left out. A small image is near the processor as a whole, and left alone.
inline void touchWindow(const cv::Mat& image, double u, double v, int across, int down) {
  constexpr int kStep = 64 / sizeof(float);  // columns of a cache line
  constexpr size_t kSmall = 400000;          // bytes
  if (image.total() * sizeof(float) < kSmall) return;
  if (!(u >= 0 && v >= 0 && u < image.cols && v < image.rows)) return;
  const int first = std::max(static_cast<int>(u) - across, 0);
  const int last = std::min(static_cast<int>(u) + across, image.cols - 1);
  const int top = std::max(static_cast<int>(v) - down, 0);
  const int end = std::min(static_cast<int>(v) + down, image.rows - 1);
  const size_t stride = image.step[0] / sizeof(float);
  for (int column = first;; column = std::min(column + kStep, last)) {
    const volatile float* pixel = image.ptr<float>(top) + column;
    for (int row = top; row <= end; ++row, pixel += stride) static_cast<void>(*pixel);
    if (column == last) break;
  }
}

/// The same for one pixel of a mask.
inline void touchPixel(const cv::Mat& mask, double u, double v) {
  if (u >= 0 && v >= 0 && u < mask.cols && v < mask.rows)
    static_cast<void>(
        *static_cast<const volatile uchar*>(mask.ptr(static_cast<int>(v)) + static_cast<int>(u)));
}

}  // namespace uav_landing
