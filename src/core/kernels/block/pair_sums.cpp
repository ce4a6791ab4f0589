#include "kernels/block/pair_sums.h"

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

// Derivative of fourth order, because the difference of two neighbours sees too little of fine texture.
[[gnu::always_inline]] inline void derivative(const float* at, std::ptrdiff_t step, Lanes& out) {
  Lanes before2, before, after, after2;
  load(at - 2 * step, before2);
  load(at - step, before);
  load(at + step, after);
  load(at + 2 * step, after2);
  out = (8.f * (after - before) - (after2 - before2)) / 12.f;
}

}  // namespace

UAV_LANDING_MULTIVERSION PairSums addUpPair(const float* left, const float* right, std::ptrdiff_t stride,
                                            int width, int height) {
  Lanes lefts{}, rights{}, products{}, slope_left{}, slope_right{}, slopes{}, down{}, signal{};
  for (int y = 0; y < height; ++y, left += stride, right += stride) {
    for (int x = 0; x < width; x += kLanes) {
      Lanes l, before, after, below, r, beside;
      load(left + x, l);
      load(left + x - 1, before);
      load(left + x + 1, after);
      load(right + x, r);
      derivative(left + x, stride, below);
      derivative(right + x, 1, beside);
      const Lanes slope = 0.5f * (after - before);
      lefts += l * l;
      rights += r * r;
      products += l * r;
      slope_left += slope * l;
      slope_right += slope * r;
      slopes += slope * slope;
      down += slope * below;
      signal += slope * beside;
    }
  }
  PairSums sums;
  sums.left = sum(lefts);
  sums.right = sum(rights);
  sums.products = sum(products);
  sums.slope_left = sum(slope_left);
  sums.slope_right = sum(slope_right);
  sums.slopes = sum(slopes);
  sums.down = sum(down);
  sums.signal = sum(signal);
  return sums;
}

}  // namespace uav_landing
