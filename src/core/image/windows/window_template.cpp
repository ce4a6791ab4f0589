#include "image/windows/window_template.h"

#include "kernels/window/window_copy.h"
#include "kernels/window/window_layout.h"

namespace uav_landing {

bool WindowTemplate::load(const cv::Mat& image, int u, int v, int radius) {
  constexpr double kMinContrast = 1.0;
  if (u < radius || v < radius || u + radius >= image.cols || v + radius >= image.rows) return false;
  const int size = 2 * radius + 1;
  values.resize(static_cast<size_t>(size) * size);
  copyWindow(image.ptr<float>(v - radius) + u - radius, rowStride(image), size, values.data());
  const int count = size * size;
  mean = sumOf(values.data(), count) / count;
  energy = subtractAndSquare(static_cast<float>(mean), values.data(), count);
  return energy > kMinContrast * kMinContrast * count;
}

}  // namespace uav_landing
