#include "simulator/ground/noise_tile.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

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

}  // namespace

NoiseTile::NoiseTile(uint64_t seed, double slope) : map_(makeNoise(kSize, seed, slope)) {}

}  // namespace uav_landing
