#pragma once

#include <array>
#include <cstddef>

#include "kernels/lanes/lanes.h"

namespace uav_landing {

/// Numbers of which one in the middle is looked for, up to kMost, filled up to whole lanes by infinity.
template <int kMost>
struct PaddedValues {
  static_assert(kMost % kLanes == 0, "whole lanes");
  alignas(sizeof(Lanes)) std::array<float, kMost> values;
  int count = 0;

  /// After count and that many values have been set.
  void pad() {
    for (int i = count; i < wholeLanes(count); ++i) values[i] = __builtin_inff();
  }
};

/// Of values >= 0, the one that as many as rank stand before when they are put in order. values: whole lanes,
/// filled up by infinity; count: of the lanes' values. guess: roughly what is looked for, > 0. Counts the
/// values below some limits instead of putting any in order: no choice that a processor would guess wrong.
float orderStatistic(const float* values, int count, int rank, float guess);

template <int kMost>
float orderStatistic(const PaddedValues<kMost>& padded, int rank, float guess) {
  return orderStatistic(padded.values.data(), wholeLanes(padded.count), rank, guess);
}

/// The same of any numbers, in any order, not filled up. NaN when some of them are not finite and none is
/// found.
double orderStatistic(const double* values, size_t count, size_t rank);

}  // namespace uav_landing
