#pragma once

#include <vector>

namespace uav_landing {

/// How a pixel weights the light around its centre before sampling. When the lens blurs little, the weight is
/// even over the pixel. When it blurs enough, the weight is a tent of twice the width, which passes much less
/// detail that is finer than pixels. If the image were blurred only after sampling, edges far ahead would
/// alias and move differently from the scene.
class PixelFilter {
 public:
  /// samples: number along each side of a pixel. blur: 1 sigma of the lens, px.
  PixelFilter(int samples, double blur);
  /// The same with twice the samples along each side.
  PixelFilter finer() const { return PixelFilter(2 * side_samples_, blur_, tent_); }

  /// A square piece of the pixel's surroundings. du, dv: from the pixel's centre to its middle, px.
  struct Sample {
    float du, dv;
    float weight;  ///< their sum is 1
  };
  const std::vector<Sample>& samples() const { return samples_; }
  float sampleSide() const { return sample_side_; }
  /// Side of the square that holds all samples, px.
  float support() const { return support_; }
  /// Side of the evenly weighted square that has the filter's variance, px.
  float equivalentSide() const { return equivalent_side_; }
  /// Share of a point's light that a pixel takes in. du, dv: from the pixel's centre to the point, px. The
  /// shares of all pixels add up to 1.
  double weightOf(double du, double dv) const { return share(du) * share(dv); }
  /// 1 sigma of the lens's blur that remains to be applied after sampling, px.
  double blurLeft() const { return blur_left_; }

 private:
  PixelFilter(int samples, double blur, bool tent);
  double share(double offset) const;

  int side_samples_;
  double blur_;
  bool tent_;
  std::vector<Sample> samples_;
  float sample_side_, support_, equivalent_side_;
  double blur_left_;
};

}  // namespace uav_landing
