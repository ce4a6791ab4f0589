#include "uav_landing/simulator/noise_tile.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

/// White noise whose spectrum is scaled by |frequency|^-slope, without its mean. Periodic, as spectra are.
cv::Mat makeNoise(int size, uint64_t seed, double slope) {
  cv::Mat noise(size, size, CV_32F);
  cv::RNG(seed * 0x9E3779B97F4A7C15ULL + 1).fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
  cv::Mat spectrum;
  cv::dft(noise, spectrum, cv::DFT_COMPLEX_OUTPUT);
  spectrum.forEach<cv::Vec2f>([&](cv::Vec2f& value, const int* position) {
    const double fy = std::min(position[0], size - position[0]),
                 fx = std::min(position[1], size - position[1]);
    const double frequency = std::hypot(fx, fy);
    value *= frequency > 0 ? static_cast<float>(std::pow(frequency, -slope)) : 0.0f;
  });
  cv::dft(spectrum, noise, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT);
  return noise / std::sqrt(noise.dot(noise) / noise.total());
}

/// log2, exact at powers of two and linear in between: continuous and monotone is all that is needed here.
float roughLog2(float x) {
  uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const auto exponent = static_cast<int>(bits >> 23) - 127;
  return static_cast<float>(exponent) + static_cast<float>(bits & 0x7FFFFFu) / 8388608.0f;
}

/// std::floor is a function call on processors without SSE 4.1; this is where most of the time goes.
int roundDown(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}

/// Whole and fractional level whose averaging, together with the linear interpolation between its texels, has
/// the variance of a box of this width: box plus interpolation are sqrt(3) times as wide as the box alone.
struct Level {
  int whole;
  float fraction;
  Level(float width, int levels) {
    const float exact = std::clamp(roughLog2(width * 0.57735f), 0.0f, static_cast<float>(levels - 1));
    whole = std::min(static_cast<int>(exact), levels - 2);
    fraction = exact - static_cast<float>(whole);
  }
};

}  // namespace

NoiseTile::NoiseTile(uint64_t seed, double slope) : levels_(kLevels * kLevels) {
  levels_[0] = makeNoise(kSize, seed, slope);
  for (int i = 0; i < kLevels; ++i) {
    for (int j = 0; j < kLevels; ++j) {
      if (i + j == 0) continue;
      const cv::Mat& finer = j > 0 ? levels_[i * kLevels + j - 1] : levels_[(i - 1) * kLevels];
      cv::resize(finer, levels_[i * kLevels + j], cv::Size(kSize >> i, kSize >> j), 0, 0, cv::INTER_AREA);
    }
  }
}

float NoiseTile::bilinear(int i, int j, float x, float y) const {
  const int columns = kSize >> i, rows = kSize >> j;
  const float u = x / static_cast<float>(1 << i) - 0.5f, v = y / static_cast<float>(1 << j) - 0.5f;
  const int column = roundDown(u), row = roundDown(v);
  const float fu = u - static_cast<float>(column), fv = v - static_cast<float>(row);
  const int u0 = column & (columns - 1), u1 = (u0 + 1) & (columns - 1);
  const int v0 = row & (rows - 1), v1 = (v0 + 1) & (rows - 1);
  const float* data = level(i, j);
  const float* upper = data + v0 * columns;
  const float* lower = data + v1 * columns;
  const float top = upper[u0] + fu * (upper[u1] - upper[u0]);
  const float bottom = lower[u0] + fu * (lower[u1] - lower[u0]);
  return top + fv * (bottom - top);
}

float NoiseTile::mean(float x, float y, float width, float height) const {
  const Level i(width, kLevels), j(height, kLevels);
  const auto blend = [&](int column_level) {
    const float fine = bilinear(column_level, j.whole, x, y);
    if (j.fraction == 0.0f) return fine;
    return fine + j.fraction * (bilinear(column_level, j.whole + 1, x, y) - fine);
  };
  const float fine = blend(i.whole);
  if (i.fraction == 0.0f) return fine;
  return fine + i.fraction * (blend(i.whole + 1) - fine);
}

}  // namespace uav_landing
