#include "stereo/photometric/texture_bands.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

// Standard deviations of the Gaussians, pixels of the image.
constexpr double kSmooth = 1.0, kSmoother = 2.5, kSmoothest = 6.4;
// Variance of a place within the two pixels that are one of the reduced image.
constexpr double kReducing = 0.25;

/// From one standard deviation to another, in pixels of the reduced image.
double reducedSigma(double from_variance, double to) { return 0.5 * std::sqrt(to * to - from_variance); }

void blur(const cv::Mat& image, double sigma, cv::Mat& out) {
  // Rows of the same memory beside the image's are none of it.
  cv::GaussianBlur(image, out, cv::Size(), sigma, sigma, cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
}

}  // namespace

void TextureBands::Rows::create(const cv::Size& size) {
  if (memory.cols != size.width || memory.rows < size.height) memory.create(size, CV_32F);
  image = memory.rowRange(0, size.height);
}

void TextureBands::split(const cv::Mat& image) {
  const cv::Size whole = image.size(), half = whole / 2;
  smooth_.create(whole);
  bands_[0].create(whole);
  for (Rows* rows : {&reduced_, &smoother_, &smoothest_, &bands_[1], &bands_[2]}) rows->create(half);
  blur(image, kSmooth, smooth_.image);
  cv::subtract(image, smooth_.image, bands_[0].image);
  cv::resize(smooth_.image(cv::Rect(cv::Point(), half * 2)), reduced_.image, half, 0, 0, cv::INTER_AREA);
  blur(reduced_.image, reducedSigma(kSmooth * kSmooth + kReducing, kSmoother), smoother_.image);
  cv::subtract(reduced_.image, smoother_.image, bands_[1].image);
  blur(smoother_.image, reducedSigma(kSmoother * kSmoother, kSmoothest), smoothest_.image);
  cv::subtract(smoother_.image, smoothest_.image, bands_[2].image);
}

}  // namespace uav_landing
