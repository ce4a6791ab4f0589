#pragma once

#include <algorithm>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Reads the surroundings of a place of a float image that is needed soon, so that they are in the cache.
/// Windows of corners lie anywhere in images larger than the caches. When they are read here, the processor
/// waits for all rows at once, while it works on another corner; otherwise it waits for one row after the
/// other. A prefetch instruction does not help: it does nothing when the address of the page is not cached
/// either, as is usual here.
/// across, down: pixels on each side; those outside the image are skipped. A small image fits into the cache
/// and is not touched.
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
