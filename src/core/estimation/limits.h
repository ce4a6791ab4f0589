#pragma once

#include <cmath>

namespace uav_landing {

/// A limit in standard deviations. The type keeps it apart from squared limits, with which sums of squares
/// and Mahalanobis distances are compared.
class Sigmas {
 public:
  constexpr explicit Sigmas(double count) : count_(count) {}

  constexpr double count() const { return count_; }
  /// Whether a difference of this variance is within the limit.
  bool admits(double difference, double variance) const {
    return difference * difference <= squared() * variance;
  }
  /// The same for a squared normalised difference.
  constexpr bool admitsRatio(double ratio) const { return ratio <= squared(); }
  /// Largest admitted difference of this variance.
  double bound(double variance) const { return count_ * std::sqrt(variance); }
  constexpr double squared() const { return count_ * count_; }

 private:
  double count_;
};

}  // namespace uav_landing
