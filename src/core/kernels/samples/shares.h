#pragma once

#include <cstddef>

namespace uav_landing {

/// A square with sides along the axes, by its middle.
struct Square {
  float u, v, extent;
};

/// The sum, over the places from first up to the last one before count, of the share of a square's area that
/// a square of the same size around the place has in common with it. us, vs: filled up to whole lanes with
/// anything; first: a multiple of eight.
float sumOfShares(const float* us, const float* vs, size_t first, size_t count, const Square& square);

}  // namespace uav_landing
