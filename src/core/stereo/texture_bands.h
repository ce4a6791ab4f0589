#pragma once

#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// An image taken apart by how fine its texture is: differences of Gaussians (Burt, Adelson 1983), with
/// standard deviations of 0, 1, 2.5 and 6.4 pixels. White noise in one band has next to nothing in common
/// with that in another, and what is left out has a gain and an offset in it rather than texture.
class TextureBands {
 public:
  static constexpr int kBands = 3;
  /// Pixels of the image to each side that are one of the band.
  static constexpr int factor(int band) { return band == 0 ? 1 : 2; }
  /// Of the sum over a block of the products of two images' derivatives (BandSums::signal), both white noise,
  /// the variance: this times the sum of the squares of one's and the variance of the other's band.
  static constexpr double signalNoise(int band) { return band == 0 ? 1.5 : band == 1 ? 0.44 : 0.52; }
  /// Variance of white noise in the coarsest band over that in the finest.
  static constexpr double kWhiteCoarsest = 0.0105;

  /// image: CV_32F, of no more rows than the first one had, unless memory is to be taken anew.
  void split(const cv::Mat& image);
  const cv::Mat& operator[](int band) const { return bands_[band].image; }

 private:
  /// Part of an image that is kept for its memory.
  struct Rows {
    cv::Mat memory, image;
    void create(const cv::Size& size);
  };
  Rows smooth_, reduced_, smoother_, smoothest_;
  std::array<Rows, kBands> bands_;
};

}  // namespace uav_landing
