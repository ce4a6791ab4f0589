#include "runway/position/position_axis.h"

#include <algorithm>
#include <cmath>

#include "estimation/limits.h"

namespace uav_landing {
namespace {

constexpr Sigmas kGate(5);
constexpr double kRestart = 1.0;  // s of rejected measurements after which they are accepted
constexpr double kCommon = 0.5;   // share of a measurement's variance that the next ones have in common

}  // namespace

void PositionAxis::predict(double movement, double stddev) {
  if (!known_) return;
  state_(0) += movement;
  const double by_offset = std::pow(covariance_(0, 1), 2) / covariance_(1, 1);
  const double own = std::max(covariance_(0, 0) - by_offset, 0.0);
  covariance_(0, 0) = by_offset + std::pow(std::sqrt(own) + stddev, 2);
}

bool PositionAxis::update(double value, double variance, double systematic, double seconds) {
  const Eigen::RowVector2d h(1, std::sqrt(systematic));
  const double innovation = value - h * state_, random = variance - systematic;
  const double predicted = h * covariance_ * h.transpose();
  if (known_ && !kGate.admits(innovation, predicted + common_ + random)) {
    rejected_ += seconds;
    if (rejected_ < kRestart) return false;
    *this = PositionAxis();
  }
  rejected_ = 0;
  measured_ += seconds;
  common_ = kCommon * random;
  const double own = random - common_;
  if (!known_) {
    known_ = true;
    state_ << value, 0;
    covariance_ << own + systematic, -h(1), -h(1), 1;
    return true;
  }
  const Eigen::Vector2d gain = covariance_ * h.transpose() / (predicted + own);
  state_ += gain * innovation;
  covariance_ -= gain * (predicted + own) * gain.transpose();
  return true;
}

void PositionAxis::forgetAbove(double stddev) {
  if (variance() > stddev * stddev) *this = PositionAxis();
}

}  // namespace uav_landing
