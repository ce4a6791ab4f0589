#include "landing/height/surface_ahead.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {

SurfaceAhead::Shape SurfaceAhead::follow(const StereoDepthResult& stereo, const GroundPlane& plane,
                                         bool known) {
  followUnevenness(stereo.surface_variance, known);
  Shape shape{plane, 0, 0, unevenness_};
  if (follow_bend_ && stereo.below.valid()) {
    // The corrections of the plane ahead apply to the tangent as well, because both come from the same
    // images.
    shape.below.g += stereo.below.g - stereo.plane.g;
    shape.bend = shape.below.height() - plane.height();
    shape.bend_variance = std::max(0.0, stereo.below.heightVariance() - stereo.plane.heightVariance());
  }
  last_bend_ = {shape.bend, shape.bend_variance, stereo.stamp};
  return shape;
}

SurfaceAhead::Shape SurfaceAhead::carry(double stamp) const {
  constexpr double kLasts = 1;  // s, after which the bend may as well be zero or twice as large
  Shape shape;
  shape.unevenness = unevenness_;
  if (!last_bend_) return shape;
  shape.bend = last_bend_->height;
  shape.bend_variance =
      last_bend_->variance + std::pow(last_bend_->height * (stamp - last_bend_->stamp) / kLasts, 2);
  return shape;
}

void SurfaceAhead::followUnevenness(double surface_variance, bool known) {
  constexpr int kPairs = 20;
  if (!std::isfinite(surface_variance)) return;
  pairs_ = known ? std::min(pairs_ + 1, kPairs) : 1;
  const double share = 1.0 / pairs_, before = pairs_ > 1 ? mean_ : surface_variance;
  mean_ = before + share * (surface_variance - before);
  const double square = (surface_variance - before) * (surface_variance - mean_);
  scatter_ += share * (square - scatter_);
  // The value of a pair is a small difference of two large variances. On flat ground it scatters around zero.
  // So once there are enough pairs, only what exceeds the standard error of the mean counts.
  constexpr int kEnough = 5;
  const double error = pairs_ < kEnough ? 0 : std::sqrt(scatter_ / pairs_);
  unevenness_ = std::max(0.0, mean_ - error);
}

}  // namespace uav_landing
