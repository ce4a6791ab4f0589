#include "kernels/window/window_copy.h"

#include <algorithm>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"
#include "kernels/window/window_layout.h"

namespace uav_landing {
namespace {

// The last lanes of a row end with the row.
[[gnu::always_inline]] inline void copyRowsAny(const float* image, std::ptrdiff_t stride, int size,
                                               float* out) {
  for (int y = 0; y < size; ++y, image += stride, out += size) {
    for (int x = 0; size >= kLanes && x < size; x += kLanes) {
      const int first = std::min(x, size - kLanes);
      Lanes values;
      load(image + first, values);
      store(values, out + first);
    }
    for (int x = 0; size < kLanes && x < size; ++x) out[x] = image[x];
  }
}

}  // namespace

// The usual size is known to the compiler, which then needs no loop for a row.
UAV_LANDING_MULTIVERSION void copyWindow(const float* first, std::ptrdiff_t stride, int size, float* out) {
  if (size == kUsualWindowSize) {
    copyRowsAny(first, stride, kUsualWindowSize, out);
  } else {
    copyRowsAny(first, stride, size, out);
  }
}

UAV_LANDING_MULTIVERSION double sumOf(const float* values, int count) {
  Lanes lanes{};
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    Lanes value;
    load(values + i, value);
    lanes += value;
  }
  double total = sum(lanes);
  for (; i < count; ++i) total += values[i];
  return total;
}

UAV_LANDING_MULTIVERSION void subtract(float number, float* values, int count) {
  for (int i = 0; i < count; ++i) values[i] -= number;
}

UAV_LANDING_MULTIVERSION double subtractAndSquare(float number, float* values, int count) {
  Lanes squares{};
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    Lanes value;
    load(values + i, value);
    value -= number;
    squares += value * value;
    store(value, values + i);
  }
  double total = sum(squares);
  for (; i < count; ++i) {
    values[i] -= number;
    total += values[i] * values[i];
  }
  return total;
}

}  // namespace uav_landing
