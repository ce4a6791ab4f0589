#pragma once

#include <vector>

namespace uav_landing {

/// How a pixel weights the light around its centre before it is sampled: evenly over itself or, where the
/// lens blurs by enough, by a tent over twice its sides, which leaves much less of what is finer than pixels.
/// Blurred after sampling only, edges far ahead would be aliased and move otherwise than the scene.
class PixelFilter {
 public:
  /// samples: along each side of a pixel. blur: 1 sigma of the lens, px.
  PixelFilter(int samples, double blur);
  /// The same with twice the samples along each side.
  PixelFilter finer() const { return PixelFilter(2 * side_samples_, blur_, tent_); }

  /// A square piece of the pixel's surroundings: its middle from the pixel's centre, px.
  struct Sample {
    float du, dv;
    float weight;  ///< their sum is 1
  };
  const std::vector<Sample>& samples() const { return samples_; }
  float sampleSide() const { return sample_side_; }
  /// Side of the square that holds all samples, px.
  float support() const { return support_; }
  /// Side of the square, evenly weighted, of the filter's variance, px.
  float equivalentSide() const { return equivalent_side_; }
  /// 1 sigma of the lens's blur that the filter leaves to be done after sampling, px.
  double blurLeft() const { return blur_left_; }

 private:
  PixelFilter(int samples, double blur, bool tent);

  int side_samples_;
  double blur_;
  bool tent_;
  std::vector<Sample> samples_;
  float sample_side_, support_, equivalent_side_;
  double blur_left_;
};

}  // namespace uav_landing
