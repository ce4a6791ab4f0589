#pragma once

#include <cstddef>

namespace uav_landing {

/// Rows of a square window of an image, one after the other without gaps. first: its first pixel; stride:
/// from row to row of the image.
void copyWindow(const float* first, std::ptrdiff_t stride, int size, float* out);

/// The sum of count values. Not in their order: floats in eight sums, added at the end.
double sumOf(const float* values, int count);

/// Takes a number off all values.
void subtract(float number, float* values, int count);

/// Does that, and returns the sum of the squares of what is left.
double subtractAndSquare(float number, float* values, int count);

}  // namespace uav_landing
