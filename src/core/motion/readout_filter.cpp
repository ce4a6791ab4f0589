#include "motion/readout_filter.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Successive pairs see the same ground with the same errors, by what is not flat of it and by lenses: all of
// that time count as one.
constexpr double kCorrelationTime = 4.0;  // s
// 1 sigma of what lenses and ground that is not flat make of every step alike, s.
constexpr double kLastingStddev = 0.0015;
// Squared normalised innovation beyond which a step counts less.
constexpr double kLimit = 9;

}  // namespace

void ReadoutFilter::learn(const ReadoutEffect& effect, double duration) {
  if (!(effect.information > 0) || !std::isfinite(effect.score) || !(duration > 0)) return;
  const double missing = effect.score / effect.information;
  const double variance = 1 / effect.information + 1 / information_;
  const double share =
      std::min(1.0, duration / kCorrelationTime) * std::min(1.0, kLimit * variance / (missing * missing));
  information_ += share * effect.information;
  time_ += share * effect.score / information_;
}

ReadoutEstimate ReadoutFilter::estimate() const {
  return {time_, 1 / information_ + kLastingStddev * kLastingStddev};
}

}  // namespace uav_landing
