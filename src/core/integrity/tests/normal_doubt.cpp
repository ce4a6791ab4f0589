#include "integrity/tests/normal_doubt.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr size_t kPairs = 3;

}  // namespace

// Without a fault the contradiction has the likelihood exp(-ratio / 2). A fault of just this size has the
// likelihood 1, that of no contradiction at all.
void NormalDoubt::add(double stamp, double ratio, const Eigen::Vector3d& turn, double variance, bool turned) {
  if (!(ratio >= 0) || !turn.allFinite() || !(variance >= 0)) return;
  if (turned || stamp - stamp_ > memory_) probabilities_.clear();
  const double odds_against = (1 - fault_probability_) / fault_probability_ * std::exp(-0.5 * ratio);
  probabilities_.push_back(1 / (1 + odds_against));
  if (probabilities_.size() > kPairs) probabilities_.pop_front();
  stamp_ = stamp;
  turn_ = turn;
  variance_ = variance;
}

double NormalDoubt::probability(double stamp) const {
  const bool seen_now = stamp == stamp_;
  if (probabilities_.empty() || stamp - stamp_ > memory_ || (!seen_now && probabilities_.size() < kPairs))
    return 0;
  std::deque<double> sorted = probabilities_;
  std::sort(sorted.begin(), sorted.end());
  return sorted[(sorted.size() - 1) / 2];
}

}  // namespace uav_landing
