#include "estimation/innovation_scatter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace uav_landing {
namespace {

constexpr std::size_t kPairs = 20, kFewest = 8;  // pairs that are used; fewer than kFewest say nothing
constexpr double kCertain = 1.645;               // normal quantile of 95 %, one-sided

}  // namespace

void InnovationScatter::add(double ratio) {
  if (!(ratio >= 0)) return;
  ratios_.push_back(std::min(ratio, limit_));
  if (ratios_.size() > kPairs) ratios_.pop_front();
}

double InnovationScatter::factor() const {
  const double count = static_cast<double>(ratios_.size());
  if (ratios_.size() < kFewest) return 1;
  const double mean = std::accumulate(ratios_.begin(), ratios_.end(), 0.0) / count;
  // Each ratio is a chi-square of one degree of freedom, with mean 1 and variance 2.
  return std::max(1.0, mean / (1 + kCertain * std::sqrt(2 / count)));
}

}  // namespace uav_landing
