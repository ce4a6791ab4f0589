#pragma once

#include <algorithm>
#include <cmath>

namespace uav_landing {

/// Limits of random sampling. (Fischler, Bolles: Random sample consensus, CACM 24, 1981.)
struct RansacOptions {
  int most = 80;         ///< largest number of candidates
  int draws_each = 1;    ///< largest number of draws per candidate, as some draws give none
  int sample = 3;        ///< measurements of a sample
  double of_draws = 1;   ///< share of the draws that can be samples without outliers
  double missed = 1e-3;  ///< accepted chance that no sample without outliers was drawn
};

/// Counts draws and candidates. It ends when a sample without outliers must have been drawn.
class RansacBudget {
 public:
  explicit RansacBudget(const RansacOptions& options) : options_(options), needed_(options.most) {}

  /// Whether to draw again. Call it before each draw.
  bool goesOn() { return candidates_ < needed_ && draws_++ < options_.draws_each * options_.most; }
  /// A draw gave a candidate.
  void count() { ++candidates_; }
  /// The best candidate has this share of the measurements as inliers.
  void found(double share) {
    double all_right = 1;
    for (int i = 0; i < options_.sample; ++i) all_right *= share;
    all_right = std::clamp(all_right, 1e-9, 1 - options_.missed);
    const double draws = std::log(options_.missed) / std::log1p(-all_right) / options_.of_draws;
    needed_ = std::min<double>(options_.most, draws);
  }

 private:
  RansacOptions options_;
  double needed_;
  int draws_ = 0, candidates_ = 0;
};

}  // namespace uav_landing
