#include "height/width_height.h"

#include <algorithm>
#include <cmath>

#include "estimation/limits.h"

namespace uav_landing {
namespace {

constexpr double kKnownStddev =
    0.002;                       // 1 sigma of a known width, as a share, besides the place of the edges
constexpr double kSame = 0.005;  // share of the width; beyond it (and 4 sigma) other edges are seen
constexpr Sigmas kGate(4);
constexpr int kAgreeing = 5;  // pairs in a row before a width is learned

}  // namespace

WidthHeight::WidthHeight(double known_width, double largest_inset)
    : known_(known_width > 0), learns_(!known_ || largest_inset > kSame * known_width) {
  if (!known_) return;
  // As well at the surface's edges as at stripes inside: one standard deviation takes in both.
  const double variance = std::pow(kKnownStddev * known_width, 2) + largest_inset * largest_inset;
  width_ = Width{known_width - largest_inset, variance, kAgreeing};
}

std::optional<WidthHeight::Estimate> WidthHeight::height(double ratio, double variance) const {
  if (!width_ || width_->pairs < kAgreeing || !(ratio > 0) || !(variance > 0)) return std::nullopt;
  Estimate estimate;
  estimate.height = width_->mean / ratio;
  estimate.common = width_->variance / (ratio * ratio);
  estimate.variance = estimate.common + std::pow(estimate.height / ratio, 2) * variance;
  return estimate;
}

WidthHeight::Width WidthHeight::seen(double ratio, double variance, double height, double height_variance) {
  return {ratio * height, height * height * variance + ratio * ratio * height_variance, 1};
}

bool WidthHeight::agree(const Width& a, const Width& b) {
  return std::abs(a.mean - b.mean) <= std::max(kSame * b.mean, kGate.bound(a.variance + b.variance));
}

void WidthHeight::merge(const Width& seen, Width& width) {
  // Errors of consecutive pairs are much the same, so the width is as good as the best pair, not as their
  // mean.
  const double gain = width.variance / (width.variance + seen.variance);
  width.mean += gain * (seen.mean - width.mean);
  width.variance = std::min(width.variance, seen.variance);
  width.pairs = std::min(width.pairs + 1, kAgreeing);
}

bool WidthHeight::isSame(double ratio, double variance, double height, double height_variance) {
  if (!width_) return true;
  const Width now = seen(ratio, variance, height, height_variance);
  const double without_height = kGate.bound(width_->variance + height * height * variance);
  if (!agree(now, *width_)) {
    changed_ = true;
  } else if (std::abs(now.mean - width_->mean) <= std::max(kSame * width_->mean, without_height)) {
    changed_ = false;
  }
  return !changed_;
}

void WidthHeight::learn(double ratio, double variance, double height, double height_variance) {
  if (!learns_ || !(ratio > 0) || !(variance > 0) || !(height > 0) || !(height_variance > 0)) return;
  const Width now = seen(ratio, variance, height, height_variance);
  if (known_ && !(now.variance < width_->variance)) return;
  if (width_ && agree(now, *width_)) {
    known_ = false;
    merge(now, *width_);
    other_.reset();
    return;
  }
  if (other_ && agree(now, *other_)) {
    merge(now, *other_);
  } else {
    other_ = now;
  }
  if (width_ && width_->pairs >= kAgreeing && other_->pairs < kAgreeing) return;
  width_ = other_;
  other_.reset();
  known_ = changed_ = false;
}

}  // namespace uav_landing
