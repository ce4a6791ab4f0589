#include "uav_landing/geometry/row_turns.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace uav_landing {

RowTurns::RowTurns(double first, std::vector<Eigen::Vector3d> rates, const Eigen::Matrix3d& covariance)
    : first_(first), rates_(std::move(rates)), turns_(rates_.size()), covariance_(covariance) {
  turns_[0].setZero();
  for (size_t i = 1; i < rates_.size(); ++i)
    turns_[i] = turns_[i - 1] + kInterval / 2 * (rates_[i - 1] + rates_[i]);
  at_stamp_ = turnTo(0);
  mean_ = turns_.back() / (kInterval * static_cast<double>(rates_.size() - 1));
}

Eigen::Vector3d RowTurns::rateAt(double seconds) const {
  const double place =
      std::clamp((seconds - first_) / kInterval, 0.0, static_cast<double>(rates_.size() - 1));
  const size_t before = std::min(static_cast<size_t>(place), rates_.size() - 2);
  const double share = place - static_cast<double>(before);
  return (1 - share) * rates_[before] + share * rates_[before + 1];
}

Eigen::Vector3d RowTurns::turnTo(double seconds) const {
  const double last = first_ + kInterval * static_cast<double>(rates_.size() - 1);
  const double inside = std::clamp(seconds, first_, last), place = (inside - first_) / kInterval;
  const size_t before = std::min(static_cast<size_t>(place), rates_.size() - 2);
  const double since = inside - first_ - kInterval * static_cast<double>(before);
  return turns_[before] + since / 2 * (rates_[before] + rateAt(inside)) + (seconds - inside) * rateAt(inside);
}

Eigen::Vector3d RowTurns::beyondMean(double seconds) const {
  return turnTo(seconds) - at_stamp_ - seconds * mean_;
}

}  // namespace uav_landing
