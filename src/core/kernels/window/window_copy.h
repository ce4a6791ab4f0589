#pragma once

#include <cstddef>

namespace uav_landing {

/// Copies the rows of a square window of an image, one after the other without gaps. first: its first pixel.
/// stride: from row to row of the image.
void copyWindow(const float* first, std::ptrdiff_t stride, int size, float* out);

/// Sum of count values. They are added in eight sums of floats, which are added at the end.
double sumOf(const float* values, int count);

/// Subtracts a number from all values.
void subtract(float number, float* values, int count);

/// Subtracts a number from all values and returns the sum of their squares after that.
double subtractAndSquare(float number, float* values, int count);

}  // namespace uav_landing
