#pragma once

#include <cstddef>

namespace uav_landing {

/// A square with sides along the axes, by its middle.
struct Square {
  float u, v, extent;
};

/// Sum, over the places first to count - 1, of the overlap of a square with a square of the same size around
/// the place, as a share of its area. us, vs: filled up to whole lanes with anything. first: a multiple of
/// eight.
float sumOfShares(const float* us, const float* vs, size_t first, size_t count, const Square& square);

}  // namespace uav_landing
