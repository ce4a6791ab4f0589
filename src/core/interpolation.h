#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Catmull-Rom interpolation along a row: value and derivative by the column. Needs 1 <= x < cols - 2.
inline float cubicAt(const float* row, float x, float* derivative) {
  const int i = static_cast<int>(x);
  const float t = x - static_cast<float>(i);
  const float a = row[i - 1], b = row[i], c = row[i + 1], d = row[i + 2];
  const float c1 = 0.5f * (c - a);
  const float c2 = a - 2.5f * b + 2.f * c - 0.5f * d;
  const float c3 = 0.5f * (d - a) + 1.5f * (b - c);
  *derivative = c1 + t * (2.f * c2 + 3.f * t * c3);
  return b + t * (c1 + t * (c2 + t * c3));
}

/// Linear interpolation along a row. Needs 0 <= x < cols - 1.
inline float linearAt(const float* row, float x) {
  const int i = static_cast<int>(x);
  const float t = x - static_cast<float>(i);
  return row[i] + t * (row[i + 1] - row[i]);
}

/// Catmull-Rom interpolation of a float image. Needs 1 <= x < cols - 2 and 1 <= y < rows - 2.
inline float cubicAt(const cv::Mat& image, double x, double y) {
  const int i = static_cast<int>(y);
  float column[4], derivative;
  for (int k = 0; k < 4; ++k) {
    column[k] = cubicAt(image.ptr<float>(i - 1 + k), static_cast<float>(x), &derivative);
  }
  return cubicAt(column, 1.f + static_cast<float>(y - i), &derivative);
}

}  // namespace uav_landing
