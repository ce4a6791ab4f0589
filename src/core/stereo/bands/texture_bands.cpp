#include "stereo/bands/texture_bands.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

// Standard deviations of the Gaussians, pixels of the image.
constexpr double kSmooth = 1.0, kSmoother = 2.5, kSmoothest = 6.4;
// Variance of a place within the two pixels that become one of the reduced image.
constexpr double kReducing = 0.25;

/// From one standard deviation to another, in pixels of the reduced image.
double reducedSigma(double from_variance, double to) { return 0.5 * std::sqrt(to * to - from_variance); }

void blur(const cv::Mat& image, double sigma, cv::Mat& out) {
  const int size = 2 * static_cast<int>(std::lround(3 * sigma)) + 1;
  // Rows beside the image in the same memory do not belong to it.
  cv::GaussianBlur(image, out, {size, size}, sigma, sigma, cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
}

}  // namespace

TextureBands::TextureBands(const cv::Size& largest)
    : smooth_(largest),
      reduced_(largest / 2),
      smoother_(largest / 2),
      smoothest_(largest / 2),
      bands_{Rows(largest), Rows(largest / 2), Rows(largest / 2)} {}

void TextureBands::split(const cv::Mat& image) {
  const cv::Size whole = image.size(), half = whole / 2;
  for (Rows* rows : {&smooth_, &bands_[0]}) rows->setCount(whole.height);
  for (Rows* rows : {&reduced_, &smoother_, &smoothest_, &bands_[1], &bands_[2]}) rows->setCount(half.height);
  blur(image, kSmooth, smooth_.image);
  cv::subtract(image, smooth_.image, bands_[0].image);
  cv::resize(smooth_.image(cv::Rect(cv::Point(), half * 2)), reduced_.image, half, 0, 0, cv::INTER_AREA);
  blur(reduced_.image, reducedSigma(kSmooth * kSmooth + kReducing, kSmoother), smoother_.image);
  cv::subtract(reduced_.image, smoother_.image, bands_[1].image);
  blur(smoother_.image, reducedSigma(kSmoother * kSmoother, kSmoothest), smoothest_.image);
  cv::subtract(smoother_.image, smoothest_.image, bands_[2].image);
}

}  // namespace uav_landing
