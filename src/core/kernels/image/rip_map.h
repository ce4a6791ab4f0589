#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// A square texture that repeats. The mean over any axis-aligned rectangle takes the same short time. To that
/// end, copies averaged over 2^i x 2^j texels are kept for all i and j (a rip-map).
class RipMap {
 public:
  /// texels: CV_32FC1, as wide as high, a power of two, at least 2.
  explicit RipMap(const cv::Mat& texels);

  /// Mean over a rectangle of width x height texels around (x, y). Texel i covers [i, i + 1).
  ///
  /// A copy is interpolated by a quadratic B-spline over three texels. Its variance is the same wherever
  /// between the texels it is evaluated. The variance of linear interpolation is not, and makes the texture
  /// flicker. Between copies the mean is interpolated linearly. So a pixel averages with a spline that has
  /// zeros at all multiples of the pixels' own frequency. Detail that pixels cannot show does not come back
  /// as false coarse texture that differs between the cameras. This costs as much sharpness as 0.5 px of
  /// blur.
  float mean(float x, float y, float width, float height) const;

 private:
  struct Copies;
  struct Places;
  float interpolate(const Copies& copies, const Places& places, int column, int row) const;

  int levels_;  ///< 2^(levels - 1) texels are the whole side
  /// [i * levels + j]: averaged over 2^i columns and 2^j rows. They are transposed, and each ends with its
  /// first texels again. So three texels below each other lie side by side, wherever they begin.
  std::vector<cv::Mat> copies_;
};

}  // namespace uav_landing
