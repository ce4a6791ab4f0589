#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// A square texture that repeats. The mean over any axis-aligned rectangle takes the same short time. To that
/// end, levels averaged over 2^i x 2^j texels are kept for all i and j (a rip-map).
class RipMap {
 public:
  /// texels: CV_32FC1, as wide as high, a power of two, at least 2.
  explicit RipMap(const cv::Mat& texels);

  /// Mean over a rectangle of width x height texels around (x, y). Texel i covers [i, i + 1). Both extents
  /// are positive; below one texel the finest level counts.
  ///
  /// A level is interpolated by a quadratic B-spline over three texels, and the mean linearly between levels.
  float mean(float x, float y, float width, float height) const;

 private:
  struct Levels;
  struct Taps;
  float interpolate(const Levels& levels, const Taps& taps, int column, int row) const;

  int count_;  ///< 2^(count - 1) texels are the whole side
  /// [i * count + j]: averaged over 2^i columns and 2^j rows. They are transposed, and each ends with its
  /// first texels again. So texels below each other lie side by side, wherever they begin.
  std::vector<cv::Mat> levels_;
};

}  // namespace uav_landing
