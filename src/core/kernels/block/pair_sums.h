#pragma once

#include <cstddef>

namespace uav_landing {

/// Sums over the pixels of a block of two images: of their values, and of the slope, which is the left
/// image's derivative along the row.
struct PairSums {
  float left = 0, right = 0, products = 0;  ///< left^2, right^2, left right
  float slope_left = 0, slope_right = 0;    ///< slope left, slope right
  float slopes = 0, down = 0;               ///< slope^2, slope (derivative down the column)
  float signal = 0;                         ///< slope (right image's derivative along the row)
};

/// left, right: the block's first pixels. stride: from row to row of both. width: a multiple of eight. Up to
/// two pixels on all sides of the block are read.
PairSums addUpPair(const float* left, const float* right, std::ptrdiff_t stride, int width, int height);

}  // namespace uav_landing
