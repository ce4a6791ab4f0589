#include "uav_landing/window_template.h"

namespace uav_landing {

bool WindowTemplate::load(const cv::Mat& image, int u, int v, int radius) {
  constexpr double kMinContrast = 1.0;
  if (u < radius || v < radius || u + radius >= image.cols || v + radius >= image.rows) return false;
  const int size = 2 * radius + 1;
  values.resize(static_cast<size_t>(size) * size);
  float* out = values.data();
  float sum = 0;
  for (int dy = 0; dy < size; ++dy, out += size) {
    const float* row = image.ptr<float>(v - radius + dy) + u - radius;
    for (int dx = 0; dx < size; ++dx) {
      out[dx] = row[dx];
      sum += row[dx];
    }
  }
  const double count = static_cast<double>(values.size());
  mean = sum / count;
  float squares = 0;
  for (float& value : values) {
    value -= static_cast<float>(mean);
    squares += value * value;
  }
  energy = squares;
  return energy > kMinContrast * kMinContrast * count;
}

}  // namespace uav_landing
