#pragma once

#include <cstddef>
#include <deque>

namespace uav_landing {

/// How far what the last pairs measured scatters about its predictions, over what is claimed: the variance
/// factor a posteriori of least squares. Claims that are wrong by a common factor, as where nobody knows how
/// blur and noise work together, leave the estimate as good as it can be, but neither its variance nor what
/// is computed from that.
class InnovationScatter {
 public:
  /// limit: squared normalised innovation as which every larger one counts: one wrong pair says nothing of
  /// the others.
  explicit InnovationScatter(double limit) : limit_(limit) {}
  /// ratio: squared normalised innovation of one measurement.
  void add(double ratio);
  /// By which variances are larger than claimed, as far as that is certain: 95 %. 1 where they may be right.
  double factor() const;
  void reset() { ratios_.clear(); }

 private:
  double limit_;
  std::deque<double> ratios_;
};

}  // namespace uav_landing
