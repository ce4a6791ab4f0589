#pragma once

#include <cstddef>
#include <deque>

namespace uav_landing {

/// Scatter of the last measurements about their predictions, over what is claimed: the variance factor a
/// posteriori of least squares. Claims may be wrong by a common factor, for example when nobody knows how
/// blur and noise work together. The estimate is then still as good as it can be, but its variance is wrong,
/// and so is everything computed from it.
class InnovationScatter {
 public:
  /// limit: largest squared normalised innovation; larger ones count as this one, because one wrong pair says
  /// nothing of the others.
  explicit InnovationScatter(double limit) : limit_(limit) {}
  /// ratio: squared normalised innovation of one measurement.
  void add(double ratio);
  /// Factor by which variances exceed their claims with a certainty of 95 %. 1 when the claims may be right.
  double factor() const;
  void reset() { ratios_.clear(); }

 private:
  double limit_;
  std::deque<double> ratios_;
};

}  // namespace uav_landing
