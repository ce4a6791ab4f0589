#include "kernels/edges/edge_growth.h"

#include <cmath>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/lanes/multiversion.h"

namespace uav_landing {

namespace {

constexpr int kFirstLook = 3;         // stations on each side after which texture mostly shows
constexpr int kDense = 8;             // stations on each side after which every second row is enough
constexpr double kSameEdge = 1.25;    // px from the line
constexpr int kLeft = 3, kRight = 4;  // pixels loaded together with the middle one

/// Column of the strongest brightness step of this sign along a row, within a pixel of a place; -1 when it is
/// weaker than least.
[[gnu::always_inline]] inline int strongestStep(const PixelRows& pixels, int row, int middle, int sign,
                                                int least) {
  if (middle < kLeft || middle + kRight >= pixels.columns) return -1;
  const uchar* pixel = pixels.first + row * pixels.step + middle - kLeft;
  const cv::v_uint16x8 here = cv::v_load_expand(pixel);
  const cv::v_int16x8 sums = cv::v_reinterpret_as_s16(here + here + cv::v_load_expand(pixel - pixels.step) +
                                                      cv::v_load_expand(pixel + pixels.step));
  const cv::v_int16x8 steps = cv::v_rotate_right<2>(sums) - sums;  // i: across pixel middle - 2 + i
  // Among equal steps the middle one wins, then the one before. This order is in the lowest bits; the lower
  // two of them are the place from middle - 1.
  constexpr short kBase = 8, kPlace = 3, kBefore = 4 + 0, kMiddle = 4 + 1, kAfter = 2;
  const cv::v_int16x8 coded = cv::v_mul_wrap(steps, cv::v_setall_s16(static_cast<short>(kBase * sign))) +
                              cv::v_int16x8(0, kBefore, kMiddle, kAfter, 0, 0, 0, 0);
  const cv::v_int16x8 best =
      cv::v_max(coded, cv::v_max(cv::v_rotate_right<1>(coded), cv::v_rotate_right<2>(coded)));
  const int strongest = cv::v_rotate_right<1>(best).get0();
  return strongest < kBase * least ? -1 : middle - 1 + (strongest & kPlace);
}

/// Stations on one side of the seed.
struct Side {
  int step, most;  ///< most: to the image's border
  int end = 0, misses = 0;
  bool open = true;
};

}  // namespace

UAV_LANDING_MULTIVERSION GrownEdge growEdge(const PixelRows& image, const EdgeMask& mask, const Seed& seed,
                                            const GrowthLimits& limits) {
  const PixelRows pixels = image;
  const EdgeMask allowed = mask;
  const int u = seed.u, sign = seed.sign, least = limits.least;
  Side sides[] = {{1, pixels.rows - 2 - seed.v}, {-1, seed.v - 1}};
  GrowingLine line(seed.slope);
  line.add(0, 0);
  line.fit();
  Straight before = line.straight();
  int looked = 1;
  for (int distance = 1, skip = 1; sides[0].open || sides[1].open; distance += skip) {
    if (distance > kDense) skip = 2;
    const Straight now = line.straight();
    UAV_LANDING_UNROLL
    for (Side& side : sides) {
      if (!side.open) continue;
      const int station = side.step * distance, v = seed.v + station;
      ++looked;
      // The line of one fit ago mostly leads to the same pixel, so that pixel is read while the fit is still
      // computed.
      const double expected = u + now.at(station);
      const int middle = static_cast<int>(expected + 0.5);
      const int guess = static_cast<int>(u + before.at(station) + 0.5);
      int found = -1;
      if (distance <= side.most) {
        found = strongestStep(pixels, v, guess, sign, least);
        if (guess != middle) found = strongestStep(pixels, v, middle, sign, least);
      }
      if (found >= 0 && expected >= kLeft && allowed.has(found, v) &&
          std::abs(found - expected) < kSameEdge) {
        line.add(station, found - u);
        side.end = station;
        side.misses = 0;
      } else if (++side.misses * skip > limits.max_gap) {
        side.open = false;
        looked -= side.misses;
      }
    }
    before = now;
    line.fit();
    if (distance == kFirstLook && !GrownEdge{line, 0, 0, looked}.isShown()) break;
  }
  return {line, sides[1].end, sides[0].end, looked};
}

}  // namespace uav_landing
