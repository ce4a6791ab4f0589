#pragma once

#include <cmath>

namespace uav_landing {

/// A limit in standard deviations. It cannot be mixed up with one of squared ones, which a sum of squares or
/// a Mahalanobis distance is compared with.
class Sigmas {
 public:
  constexpr explicit Sigmas(double count) : count_(count) {}

  constexpr double count() const { return count_; }
  /// Whether a difference of this variance is within the limit.
  bool admits(double difference, double variance) const {
    return difference * difference <= squared() * variance;
  }
  /// Whether a squared normalised difference is.
  constexpr bool admitsRatio(double ratio) const { return ratio <= squared(); }
  /// The largest difference of this variance.
  double bound(double variance) const { return count_ * std::sqrt(variance); }
  constexpr double squared() const { return count_ * count_; }

 private:
  double count_;
};

}  // namespace uav_landing
