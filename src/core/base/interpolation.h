#pragma once

#include <opencv2/core.hpp>

#include "base/lanes.h"

namespace uav_landing {

/// Catmull-Rom interpolation at t (0 to 1) between b and c, with a before and d behind them.
inline float cubicBetween(float a, float b, float c, float d, float t) {
  const float c1 = 0.5f * (c - a);
  const float c2 = a - 2.5f * b + 2.f * c - 0.5f * d;
  const float c3 = 0.5f * (d - a) + 1.5f * (b - c);
  return b + t * (c1 + t * (c2 + t * c3));
}

/// The same for eight places at once.
[[gnu::always_inline]] inline void cubicBetween(const Lanes& a, const Lanes& b, const Lanes& c,
                                                const Lanes& d, const Lanes& t, Lanes& out) {
  const Lanes rise = c - b;
  const Lanes c1 = 0.5f * (c - a), c3 = 0.5f * (d - a) - 1.5f * rise, c2 = rise - c1 - c3;
  out = b + t * (c1 + t * (c2 + t * c3));
}

/// The same for eight places, each between the second and the third of five neighbours, or the third and the
/// fourth where t, counted from the second, is 1 to 2. from: where the neighbours of all places begin.
[[gnu::always_inline]] inline void cubicBetween(const float* const (&from)[5], const Lanes& t, Lanes& out) {
  Lanes p0, p1, p2, p3, p4;
  load(from[0], p0);
  load(from[1], p1);
  load(from[2], p2);
  load(from[3], p3);
  load(from[4], p4);
  const auto next = t >= 1;
  cubicBetween(next ? p1 : p0, next ? p2 : p1, next ? p3 : p2, next ? p4 : p3, next ? t - 1 : t, out);
}

/// The same where every t is below 1, so that four neighbours do.
[[gnu::always_inline]] inline void cubicBetween(const float* const (&from)[4], const Lanes& t, Lanes& out) {
  Lanes p0, p1, p2, p3;
  load(from[0], p0);
  load(from[1], p1);
  load(from[2], p2);
  load(from[3], p3);
  cubicBetween(p0, p1, p2, p3, t, out);
}

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

/// Catmull-Rom weights of the four samples around the fraction t between the middle two.
inline void cubicWeights(float t, float* weights) {
  const float t2 = t * t, t3 = t2 * t;
  weights[0] = 0.5f * (-t + 2.f * t2 - t3);
  weights[1] = 0.5f * (2.f - 5.f * t2 + 3.f * t3);
  weights[2] = 0.5f * (t + 4.f * t2 - 3.f * t3);
  weights[3] = 0.5f * (t3 - t2);
}

/// Linear interpolation along a row. Needs 0 <= x < cols - 1.
inline float linearAt(const float* row, float x) {
  const int i = static_cast<int>(x);
  const float t = x - static_cast<float>(i);
  return row[i] + t * (row[i + 1] - row[i]);
}

/// Bilinear interpolation of a float image. Needs 0 <= x < cols - 1 and 0 <= y < rows - 1.
inline float linearAt(const cv::Mat& image, double x, double y) {
  const int i = static_cast<int>(y);
  const float t = static_cast<float>(y - i);
  const float above = linearAt(image.ptr<float>(i), static_cast<float>(x));
  return above + t * (linearAt(image.ptr<float>(i + 1), static_cast<float>(x)) - above);
}

/// Catmull-Rom interpolation of a float image. Needs 1 <= x < cols - 2 and 1 <= y < rows - 2.
inline float cubicAt(const cv::Mat& image, double x, double y) {
  const int i = static_cast<int>(y);
  const int j = static_cast<int>(x);
  float weights[4], column[4];
  cubicWeights(static_cast<float>(x - j), weights);
  for (int k = 0; k < 4; ++k) {
    const float* p = image.ptr<float>(i - 1 + k) + j - 1;
    column[k] = weights[0] * p[0] + weights[1] * p[1] + weights[2] * p[2] + weights[3] * p[3];
  }
  cubicWeights(static_cast<float>(y - i), weights);
  return weights[0] * column[0] + weights[1] * column[1] + weights[2] * column[2] + weights[3] * column[3];
}

}  // namespace uav_landing
