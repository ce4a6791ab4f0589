#pragma once

#include <optional>

#include "far/surface_disparity.h"

namespace uav_landing {

/// What stereo says of the scale of a surface that is followed, from pair to pair.
///
/// The disparity of a surface over its width in the image is the baseline over its width in metres. That
/// stays the same while the aircraft comes nearer, so it is averaged over the last pairs, where each counts
/// by its noise. A bias does not average out.
class StereoScale {
 public:
  /// Takes the disparity of a pair in, and returns that of this pair by all of them. T: s since the pair
  /// before. width: of the surface in the image, where the disparity holds, px.
  SurfaceDisparity follow(double T, const SurfaceDisparity& seen, double width);

 private:
  /// Disparity over width.
  struct Ratio {
    double value, variance;  // by the noise of the images
    double by_bias;          // growth with the disparities' bias, 1/px
  };
  std::optional<Ratio> mean_;
};

}  // namespace uav_landing
