#include "integrity/tests/runway_identity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kPatience = 1;  // s without a pair, after which any runway may be in view
constexpr double kMean = 0.5;    // s, over which margins are averaged
constexpr double kFade = 3;      // s, in which a margin fades while no runway stands out from other lines
constexpr int kMostLeaps = 3;    // jumps in a row of a direction that is not believed

}  // namespace

void RunwayIdentity::follow(double stamp, const Seen& seen, const Eigen::Vector3d& normal,
                            const ApproachAngleResult::Motion& turn) {
  const double seconds = advance(stamp);
  other_probability_ = 1;
  const Eigen::Vector3d& direction = seen.direction.direction;
  const Eigen::Vector3d across = normal.cross(direction).normalized();
  const bool leaps = memory_.leaps(stamp, seen.direction, across, turn);
  if (!direction.allFinite()) {
    leaps_ = 0;
    margin_ *= std::exp(-seconds / kFade);
    return;
  }
  if (leaps) {
    if (++leaps_ > kMostLeaps) {
      *this = RunwayIdentity();
      follow(stamp, seen, normal, turn);
    }
    return;
  }
  leaps_ = 0;
  if (memory_.agreements() == 0) pairs_ = margins_ = 0;  // another direction than in the pair before
  average(seconds, seen.margin, seen.path_known);
}

void RunwayIdentity::average(double seconds, double margin, bool path_known) {
  if (path_known && !path_known_) margins_ = 0;
  path_known_ = path_known_ || path_known;
  if (margin == 0 && pairs_ >= kConfirmations) {
    margin_ *= std::exp(-seconds / kFade);
  } else {
    const double gain = std::max(1.0 / (margins_ + 1), 1 - std::exp(-seconds / kMean));
    margin_ += gain * (margin - margin_);
    ++margins_;
    ++pairs_;
  }
  if (pairs_ >= kConfirmations) other_probability_ = std::min(1.0, std::exp(-margin_));
}

void RunwayIdentity::skip(double stamp) {
  margin_ *= std::exp(-advance(stamp) / kFade);
  leaps_ = 0;
  other_probability_ = 1;
}

double RunwayIdentity::advance(double stamp) {
  const double seconds = stamp - stamp_;
  if (!(seconds > 0 && seconds <= kPatience)) *this = RunwayIdentity();
  stamp_ = stamp;
  return seconds > 0 && seconds <= kPatience ? seconds : 0;
}

}  // namespace uav_landing
