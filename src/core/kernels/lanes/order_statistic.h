#pragma once

#include <array>
#include <cstddef>

#include "kernels/lanes/lanes.h"

namespace uav_landing {

/// Up to kMost numbers for the search for one by its rank, filled up to whole lanes with infinity.
template <int kMost>
struct PaddedValues {
  static_assert(kMost % kLanes == 0, "whole lanes");
  alignas(sizeof(Lanes)) std::array<float, kMost> values;
  int count = 0;

  /// Call it after count and that many values have been set.
  void pad() {
    for (int i = count; i < wholeLanes(count); ++i) values[i] = __builtin_inff();
  }
};

/// The value with this rank (0: the smallest) among values >= 0. values: whole lanes, filled up with
/// infinity. count: of the values in the lanes. guess: rough value of the result, > 0. It counts the values
/// below some limits instead of sorting, so the processor has no branches to mispredict.
float orderStatistic(const float* values, int count, int rank, float guess);

template <int kMost>
float orderStatistic(const PaddedValues<kMost>& padded, int rank, float guess) {
  return orderStatistic(padded.values.data(), wholeLanes(padded.count), rank, guess);
}

/// The same of any numbers, not filled up. NaN when fewer of them are finite.
double orderStatistic(const double* values, size_t count, size_t rank);

}  // namespace uav_landing
