#include "motion/step/readout_filter.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Successive pairs see the same ground with the same errors, from lenses and from ground that is not flat. So
// all pairs within this time count as one.
constexpr double kCorrelationTime = 4.0;  // s
// 1 sigma of the error that lenses and uneven ground cause in every step alike, s.
constexpr double kLastingStddev = 0.0015;
// Squared normalised innovation above which a step has less weight.
constexpr double kLimit = 9;
// Nothing is corrected when the probability of a global shutter is above this.
constexpr double kMostDoubt = 0.1;

double varianceBy(double information) { return 1 / information + kLastingStddev * kLastingStddev; }

}  // namespace

void ReadoutFilter::learn(const ReadoutEffect& effect, double duration) {
  if (!(effect.information > 0) || !std::isfinite(effect.score) || !(duration > 0)) return;
  const double missing = effect.score / effect.information + estimate().time - time_;
  const double variance = 1 / effect.information + 1 / information_;
  const double share =
      std::min(1.0, duration / kCorrelationTime) * std::min(1.0, kLimit * variance / (missing * missing));
  information_ += share * effect.information;
  time_ += share * effect.information * missing / information_;
}

// The ratio of the densities at 0, after and before the steps, is the evidence for a global shutter.
double ReadoutFilter::globalProbability() const {
  const double before = varianceBy(1 / (kPriorStddev * kPriorStddev)), variance = varianceBy(information_);
  const double odds = global_beforehand_ / (1 - global_beforehand_) * std::sqrt(before / variance) *
                      std::exp(-time_ * time_ / (2 * variance));
  return odds / (1 + odds);
}

ReadoutEstimate ReadoutFilter::estimate() const {
  const double global = globalProbability();
  const double used = time_ * std::max(0.0, 1 - global / kMostDoubt);
  const double off = time_ - used;
  return {used, (1 - global) * (varianceBy(information_) + off * off) + global * used * used};
}

}  // namespace uav_landing
