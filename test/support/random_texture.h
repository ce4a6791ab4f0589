#pragma once

#include <cmath>
#include <random>
#include <vector>

namespace uav_landing {
namespace test {

/// Smooth random function of the plane, known everywhere and not only on pixels: cubic B-spline through
/// random values on a lattice of spacing 1, repeated after 128. Mean 0, standard deviation 1; hardly any
/// detail finer than two lattice spacings.
class RandomTexture {
 public:
  explicit RandomTexture(unsigned seed) : values_(kSize * kSize) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(0.f, kScale);
    for (float& value : values_) value = normal(random);
  }

  float at(double x, double y) const {
    const double fx = std::floor(x), fy = std::floor(y);
    const int i = static_cast<int>(fx), j = static_cast<int>(fy);
    float wx[4], wy[4];
    weights(static_cast<float>(x - fx), wx);
    weights(static_cast<float>(y - fy), wy);
    float sum = 0;
    for (int b = 0; b < 4; ++b) {
      const float* row = values_.data() + kSize * ((j + b) & (kSize - 1));
      float along = 0;
      for (int a = 0; a < 4; ++a) along += wx[a] * row[(i + a) & (kSize - 1)];
      sum += wy[b] * along;
    }
    return sum;
  }

 private:
  static constexpr int kSize = 128;
  // The spline averages: it leaves 0.479 of the standard deviation (its squared weights over all phases).
  static constexpr float kScale = 1.f / 0.479f;

  static void weights(float t, float* w) {
    const float s = 1 - t;
    w[0] = s * s * s / 6;
    w[1] = (4 - 6 * t * t + 3 * t * t * t) / 6;
    w[2] = (4 - 6 * s * s + 3 * s * s * s) / 6;
    w[3] = t * t * t / 6;
  }

  std::vector<float> values_;
};

}  // namespace test
}  // namespace uav_landing
