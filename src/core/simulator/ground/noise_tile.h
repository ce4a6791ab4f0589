#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// A square of random texture that repeats without a seam, with mean 0 and variance 1. The mean over any
/// axis-aligned rectangle takes the same short time. To that end, copies averaged over 2^i x 2^j texels are
/// kept for all i and j (a rip-map). So ground that is seen at a grazing angle neither aliases nor blurs
/// sideways.
class NoiseTile {
 public:
  static constexpr int kSize = 512;  ///< texels along a side

  /// seed: picks the texture. slope: amplitudes fall with the spatial frequency f as f^-slope. A slope of 1
  /// gives every octave the same variance, and larger slopes are softer.
  NoiseTile(uint64_t seed, double slope);

  /// Mean over a rectangle of width x height texels around (x, y). The tile repeats. Texel i covers [i, i +
  /// 1).
  float mean(float x, float y, float width, float height) const;

 private:
  struct Taps;
  float interpolate(int i, int j, const Taps& column, const Taps& row) const;

  static constexpr int kLevels = 10;  ///< 2^9 texels are the whole side
  std::vector<cv::Mat> levels_;       ///< [i * kLevels + j]: averaged over 2^i columns and 2^j rows
};

}  // namespace uav_landing
