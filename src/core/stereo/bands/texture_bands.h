#pragma once

#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// An image split by how fine its texture is: differences of Gaussians (Burt, Adelson 1983) with standard
/// deviations of 0, 1, 2.5 and 6.4 pixels. The coarser rest is dropped, as it contains gain and offset rather
/// than texture.
class TextureBands {
 public:
  static constexpr int kBands = 3;
  /// Pixels of the image, along each side, that make one of the band.
  static constexpr int factor(int band) { return band == 0 ? 1 : 2; }
  /// Effect of white noise on the sums over blocks of 16 by 8 pixels (BandSums).
  struct Noise {
    /// Factor of a signal's variance when both images are noise: times slopes and the variance of the other's
    /// band.
    double signal;
    /// Correlation of the scores with those of the next coarser band.
    double alike_coarser;
    /// Largest residual by chance (three sigma) of blocks with their neighbours, over the lower quartile.
    double most;
  };
  static constexpr Noise noise(int band) {
    return band == 0 ? Noise{1.5, 0.07, 1.3} : band == 1 ? Noise{0.44, 0.35, 1.9} : Noise{0.52, 0, 2.5};
  }
  /// Variance of white noise in the coarsest band over that in the finest.
  static constexpr double kWhiteCoarsest = 0.0105;

  /// Takes and touches all memory, so that no pair has to. largest: of the images.
  explicit TextureBands(const cv::Size& largest);
  /// image: CV_32F, as wide as the largest one and not higher.
  void split(const cv::Mat& image);
  const cv::Mat& operator[](int band) const { return bands_[band].image; }

 private:
  /// Part of an image whose memory is kept.
  struct Rows {
    explicit Rows(const cv::Size& largest) : memory(cv::Mat::zeros(largest, CV_32F)) {}
    void setCount(int count) { image = memory.rowRange(0, count); }
    cv::Mat memory, image;
  };
  Rows smooth_, reduced_, smoother_, smoothest_;
  std::array<Rows, kBands> bands_;
};

}  // namespace uav_landing
