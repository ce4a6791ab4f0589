#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>

#include "kernels/lanes/lanes.h"
#include "uav_landing/parameters/window_radius.h"

/// Memory layout of windows while they are matched: rows filled up to a multiple of four, and the whole
/// window to a multiple of kLanes.
namespace uav_landing {

/// Floats from row to row of a float image. cv::Mat::step1() would be a function call.
inline std::ptrdiff_t rowStride(const cv::Mat& image) {
  return static_cast<std::ptrdiff_t>(image.step[0] / sizeof(float));
}

/// Floats from row to row of a window.
constexpr int windowStride(int radius) { return (2 * radius + 1 + 3) / 4 * 4; }

/// Rows and columns of a window of the default radius.
constexpr int kUsualWindowSize = 2 * kUsualWindowRadius + 1;

/// Memory of the largest window. The last row's lanes may be written beyond its end.
using WindowValues =
    std::array<float, windowStride(kLargestWindowRadius) * (2 * kLargestWindowRadius + 1) + kLanes>;

[[gnu::always_inline]] inline void fillUpRows(int radius, float value, float* window) {
  const int size = 2 * radius + 1, stride = windowStride(radius);
  for (int j = 0; j < size; ++j)
    for (int i = size; i < stride; ++i) window[j * stride + i] = value;
  for (int i = size * stride; i < wholeLanes(size * stride); ++i) window[i] = value;
}

/// Sets the values that fill up rows and whole lanes. The usual size is known to the compiler.
[[gnu::always_inline]] inline void fillUp(int radius, float value, float* window) {
  if (radius == kUsualWindowRadius) {
    fillUpRows(kUsualWindowRadius, value, window);
  } else {
    fillUpRows(radius, value, window);
  }
}

}  // namespace uav_landing
