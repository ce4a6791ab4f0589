#pragma once

#include "kernels/lanes/lanes.h"

namespace uav_landing {

/// Piecewise parabolic interpolation at t (0 to 1) between b and c, with a before and d behind them. It is
/// the mean of the parabola through the first three values and the one through the last three (Erup, Gardner,
/// Harris 1993, alpha = 1/4). Matches need values at the right place more than sharp ones. Catmull-Rom
/// weights the two parabolas by how near they are; texture of four pixels per period then seems up to 0.045
/// px too near a whole pixel, which pushes matches away from there. Here this error is 0.004 px.
inline float parabolicBetween(float a, float b, float c, float d, float t) {
  const float bend = 0.25f * ((a - b) - (c - d));
  return b + t * ((c - b) - (1.f - t) * bend);
}

/// The same for eight places at once.
[[gnu::always_inline]] inline void parabolicBetween(const Lanes& a, const Lanes& b, const Lanes& c,
                                                    const Lanes& d, const Lanes& t, Lanes& out) {
  const Lanes bend = 0.25f * ((a - b) - (c - d));
  out = b + t * ((c - b) - (1.f - t) * bend);
}

/// The same for eight places, each with five neighbours. t is counted from the second neighbour: below 1 the
/// place is between the second and the third, from 1 to 2 between the third and the fourth. from: first
/// neighbour of all places.
[[gnu::always_inline]] inline void parabolicBetween(const float* const (&from)[5], const Lanes& t,
                                                    Lanes& out) {
  Lanes p0, p1, p2, p3, p4;
  load(from[0], p0);
  load(from[1], p1);
  load(from[2], p2);
  load(from[3], p3);
  load(from[4], p4);
  const auto next = t >= 1;
  parabolicBetween(next ? p1 : p0, next ? p2 : p1, next ? p3 : p2, next ? p4 : p3, next ? t - 1 : t, out);
}

/// The same when every t is below 1, so that four neighbours are enough.
[[gnu::always_inline]] inline void parabolicBetween(const float* const (&from)[4], const Lanes& t,
                                                    Lanes& out) {
  Lanes p0, p1, p2, p3;
  load(from[0], p0);
  load(from[1], p1);
  load(from[2], p2);
  load(from[3], p3);
  parabolicBetween(p0, p1, p2, p3, t, out);
}

/// Weights of the four samples around the fraction t between the middle two.
inline void parabolicWeights(float t, float* weights) {
  const float outer = 0.25f * t * (t - 1.f);
  weights[0] = outer;
  weights[1] = 1.f - t - outer;
  weights[2] = t - outer;
  weights[3] = outer;
}

/// Linear interpolation along a row. Needs 0 <= x < cols - 1.
inline float linearAt(const float* row, float x) {
  const int i = static_cast<int>(x);
  const float t = x - static_cast<float>(i);
  return row[i] + t * (row[i + 1] - row[i]);
}

}  // namespace uav_landing
