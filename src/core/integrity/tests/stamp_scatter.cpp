#include "integrity/tests/stamp_scatter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimation/robust.h"

namespace uav_landing {
namespace {

constexpr size_t kSteps = 9, kFewest = 5;  // number of changes that are used; fewer than 5 say nothing
constexpr double kMoves = 3;               // sigmas that a distance must exceed
// Median of the squares of normal errors over their variance.
constexpr double kMedianOfSquares = 0.455;
// Two durations in a row share the stamp between them, with opposite signs. Their difference has 1 + 4 + 1
// times the variance of a stamp. One duration has 1 + 1 times that variance.
constexpr double kInDifference = 3;

}  // namespace

void StampScatter::follow(const CameraStep& step) {
  const auto [duration, way, variance] = step;
  if (!(duration > 0 && variance >= 0 && way > kMoves * std::sqrt(variance))) return skip();
  const Speed now{std::log(way / duration), variance / (way * way)};
  if (last_) {
    const double change = now.logarithm - last_->logarithm;
    const double by_flight = acceleration_ * duration * duration / way;
    changes_.push_back(change * change - now.variance - last_->variance - by_flight * by_flight);
    if (changes_.size() > kSteps) changes_.pop_front();
  }
  last_ = now;
}

double StampScatter::ofDuration() const {
  if (changes_.size() < kFewest) return 0;
  // The median is used because a single wrong motion is no wrong stamp.
  std::vector<double> squares(changes_.begin(), changes_.end());
  return std::max(0.0, medianOf(squares)) / kMedianOfSquares / kInDifference;
}

}  // namespace uav_landing
