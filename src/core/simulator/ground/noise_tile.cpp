#include "simulator/ground/noise_tile.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

/// White noise whose spectrum is scaled by |frequency|^-slope, without its mean. It is periodic, as spectra
/// are.
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

/// log2, exact at powers of two and linear in between. Here it only needs to be continuous and monotone.
float roughLog2(float x) {
  uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const auto exponent = static_cast<int>(bits >> 23) - 127;
  return static_cast<float>(exponent) + static_cast<float>(bits & 0x7FFFFFu) / 8388608.0f;
}

/// std::floor is a function call on processors without SSE 4.1, and most of the time is spent here.
int roundDown(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}

/// Whole and fractional level whose texels are as large as the patch. With the interpolation between the
/// texels (see Taps), a pixel then averages with a spline. It has zeros at all multiples of the pixels' own
/// frequency. So detail that pixels cannot show does not come back as false coarse texture that differs
/// between the cameras. This costs as much sharpness as 0.5 px of blur.
struct Level {
  int whole;
  float fraction;
  Level(float width, int levels) {
    const float exact = std::clamp(roughLog2(width), 0.0f, static_cast<float>(levels - 1));
    whole = std::min(static_cast<int>(exact), levels - 2);
    fraction = exact - static_cast<float>(whole);
  }
};

}  // namespace

/// Quadratic B-spline over three texels. Its variance depends little on where between the texels it is
/// evaluated. The variance of linear interpolation changes by a factor of two along each axis, and makes the
/// texture flicker.
struct NoiseTile::Taps {
  int index[3];
  float weight[3];
  Taps(float x, int level) {
    const int texels = kSize >> level;
    const float position = x / static_cast<float>(1 << level);
    const int nearest = roundDown(position);
    const float t = position - static_cast<float>(nearest) - 0.5f;
    for (int i = 0; i < 3; ++i) index[i] = (nearest + i - 1) & (texels - 1);
    weight[0] = 0.5f * (0.5f - t) * (0.5f - t);
    weight[1] = 0.75f - t * t;
    weight[2] = 0.5f * (0.5f + t) * (0.5f + t);
  }
};

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

float NoiseTile::interpolate(int i, int j, const Taps& column, const Taps& row) const {
  const float* data = levels_[i * kLevels + j].ptr<float>();
  float sum = 0;
  for (int k = 0; k < 3; ++k) {
    const float* texels = data + row.index[k] * (kSize >> i);
    sum += row.weight[k] *
           (column.weight[0] * texels[column.index[0]] + column.weight[1] * texels[column.index[1]] +
            column.weight[2] * texels[column.index[2]]);
  }
  return sum;
}

float NoiseTile::mean(float x, float y, float width, float height) const {
  const Level i(width, kLevels), j(height, kLevels);
  const Taps row(y, j.whole), coarse_row(y, j.whole + 1);
  const auto blendRows = [&](int column_level) {
    const Taps column(x, column_level);
    const float fine = interpolate(column_level, j.whole, column, row);
    if (j.fraction == 0.0f) return fine;
    return fine + j.fraction * (interpolate(column_level, j.whole + 1, column, coarse_row) - fine);
  };
  const float fine = blendRows(i.whole);
  if (i.fraction == 0.0f) return fine;
  return fine + i.fraction * (blendRows(i.whole + 1) - fine);
}

}  // namespace uav_landing
