#include "image/window_template.h"

#include <algorithm>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"
#include "kernels/window/window_layout.h"

namespace uav_landing {
namespace {

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

// The window's rows one after the other. The last lanes of a row end where it does. The usual size is known
// to the compiler, which then needs no loop for a row.
UAV_LANDING_MULTIVERSION void copyRows(const float* image, std::ptrdiff_t stride, int size, float* out) {
  if (size == kUsualWindowSize) {
    copyRowsAny(image, stride, kUsualWindowSize, out);
  } else {
    copyRowsAny(image, stride, size, out);
  }
}

// Takes the mean off; the sum of the squares of what is left.
UAV_LANDING_MULTIVERSION double centre(float* values, int count, float mean) {
  Lanes squares{};
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    Lanes value;
    load(values + i, value);
    value -= mean;
    squares += value * value;
    store(value, values + i);
  }
  double total = sum(squares);
  for (; i < count; ++i) {
    values[i] -= mean;
    total += values[i] * values[i];
  }
  return total;
}

}  // namespace

bool WindowTemplate::load(const cv::Mat& image, int u, int v, int radius) {
  constexpr double kMinContrast = 1.0;
  if (u < radius || v < radius || u + radius >= image.cols || v + radius >= image.rows) return false;
  const int size = 2 * radius + 1;
  values.resize(static_cast<size_t>(size) * size);
  copyRows(image.ptr<float>(v - radius) + u - radius, rowStride(image), size, values.data());
  const int count = size * size;
  mean = sumOf(values.data(), count) / count;
  energy = centre(values.data(), count, static_cast<float>(mean));
  return energy > kMinContrast * kMinContrast * count;
}

}  // namespace uav_landing
