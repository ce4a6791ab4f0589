#include "uav_landing/width_height.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kKnownStddev = 0.002;  // of a known width
constexpr double kSame = 0.02;          // of the width: beyond this (and 4 sigma) other edges are seen
constexpr double kGate = 4;             // sigma
constexpr int kAgreeing = 5;            // pairs in a row before a width is learned

}  // namespace

WidthHeight::WidthHeight(double known_width) : known_(known_width > 0), known_width_(known_width) { reset(); }

void WidthHeight::reset() {
  width_.reset();
  learned_ = 0;
  if (!known_) return;
  width_ = known_width_;
  variance_ = std::pow(kKnownStddev * known_width_, 2);
}

std::optional<WidthHeight::Estimate> WidthHeight::height(double ratio, double variance) const {
  if (!width_ || (!known_ && learned_ < kAgreeing) || !(ratio > 0) || !(variance > 0)) return std::nullopt;
  Estimate estimate;
  estimate.height = *width_ / ratio;
  estimate.common = variance_ / (ratio * ratio);
  estimate.variance = estimate.common + std::pow(estimate.height / ratio, 2) * variance;
  return estimate;
}

void WidthHeight::learn(double ratio, double variance, double height, double height_variance) {
  if (known_ || !(ratio > 0) || !(variance > 0) || !(height > 0) || !(height_variance > 0)) return;
  const double width = ratio * height;
  const double width_variance = height * height * variance + ratio * ratio * height_variance;
  const double tolerance =
      width_ ? std::max(kSame * *width_, kGate * std::sqrt(variance_ + width_variance)) : 0;
  if (!width_ || std::abs(width - *width_) > tolerance) {
    width_ = width;
    variance_ = width_variance;
    learned_ = 1;
    return;
  }
  // Errors of pairs in a row are much the same: the width is as good as the best of them, not as their mean.
  const double gain = variance_ / (variance_ + width_variance);
  *width_ += gain * (width - *width_);
  variance_ = std::min(variance_, width_variance);
  learned_ = std::min(learned_ + 1, kAgreeing);
}

}  // namespace uav_landing
