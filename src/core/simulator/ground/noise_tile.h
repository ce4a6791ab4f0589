#pragma once

#include <cstdint>

#include "kernels/image/rip_map.h"

namespace uav_landing {

/// A square of random texture that repeats without a seam, with mean 0 and variance 1. Ground that is seen at
/// a grazing angle neither aliases nor blurs sideways.
class NoiseTile {
 public:
  static constexpr int kSize = 512;  ///< texels along a side

  /// seed: picks the texture. slope: amplitudes fall with the spatial frequency f as f^-slope. A slope of 1
  /// gives every octave the same variance, and larger slopes are softer.
  NoiseTile(uint64_t seed, double slope);

  /// Mean over a rectangle of width x height texels around (x, y). The tile repeats. Texel i covers [i, i +
  /// 1).
  float mean(float x, float y, float width, float height) const { return map_.mean(x, y, width, height); }

 private:
  RipMap map_;
};

}  // namespace uav_landing
