#pragma once

#include <cstdint>

#include "kernels/image/rip_map.h"

namespace uav_landing {

/// A square of random texture that repeats without a seam, with mean 0 and variance 1. Ground that is seen at
/// a grazing angle neither aliases nor blurs sideways.
///
/// The quadratic B-spline between texels changes the variance little, by where it is evaluated. Linear
/// interpolation changes it by a factor of two, and makes the texture flicker. With the levels a pixel
/// averages with a spline that has zeros at all multiples of the pixels' own frequency. So detail that pixels
/// cannot show does not come back as false coarse texture that differs between the cameras. This costs as
/// much sharpness as 0.5 px of blur.
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
