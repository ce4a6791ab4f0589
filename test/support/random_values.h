#pragma once

#include <opencv2/core.hpp>
#include <random>
#include <vector>

namespace uav_landing {
namespace test {

/// Numbers between two limits, the same for the same seed.
template <class Number>
std::vector<Number> randomValues(size_t count, Number low, Number high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<Number> some(low, high);
  std::vector<Number> values(count);
  for (Number& value : values) value = some(random);
  return values;
}

/// Grey levels from 0 to 255: whole numbers in a mono8 image, any in a float image.
inline cv::Mat randomImage(int rows, int columns, int type, unsigned seed) {
  cv::Mat image(rows, columns, type);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

}  // namespace test
}  // namespace uav_landing
