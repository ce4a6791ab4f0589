#pragma once

#include <optional>

namespace uav_landing {

/// Height from the width of the runway: h = W / w with w the width seen in multiples of the height (between
/// the outermost edges, from the ground's attitude and the picture alone). W is known, or learned from
/// heights by stereo. A learned width has the errors of those heights: it carries on where stereo fails, but
/// says nothing new where it does not.
class WidthHeight {
 public:
  struct Estimate {
    double height = 0, variance = 0;  ///< m, m^2
    double common = 0;  ///< the part of the variance that is the width's own: the same on all pairs
  };

  /// known_width: m, taken as exact to 0.2 %; 0: learned.
  explicit WidthHeight(double known_width);

  /// Of one pair. ratio, variance: width over height as seen. Nothing before a width is known.
  std::optional<Estimate> height(double ratio, double variance) const;
  /// A pair with a height by stereo (m, m^2) that is believed.
  void learn(double ratio, double variance, double height, double height_variance);
  /// Whether the width does not depend on stereo.
  bool independent() const { return known_; }
  void reset();

 private:
  bool known_;
  double known_width_;
  std::optional<double> width_;  // m
  double variance_ = 0;          // m^2
  int learned_ = 0;              // pairs in a row that agree
};

}  // namespace uav_landing
