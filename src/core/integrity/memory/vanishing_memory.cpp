#include "integrity/memory/vanishing_memory.h"

#include <cmath>

#include "estimation/aircraft.h"
#include "estimation/limits.h"
#include "geometry/rotation.h"
#include "height/attitude_filter.h"

namespace uav_landing {
namespace {

constexpr int kConfirmed = 3;
constexpr double kPatience = 1.0;  // s without a direction that agrees
constexpr Sigmas kGate(5);

}  // namespace

bool VanishingMemory::leaps(double stamp, const Direction& seen, const Eigen::Vector3d& axis,
                            const ApproachAngleResult::Motion& turn) {
  carry(stamp, turn);
  if (!seen.direction.allFinite() || !seen.covariance.allFinite() || !axis.allFinite()) return false;
  if (last_) {
    const double off = axis.dot(seen.direction - last_->direction);
    const double variance = axis.dot((seen.covariance + last_->covariance) * axis);
    const bool agrees = kGate.admits(off, variance);
    if (!agrees && agreements_ >= kConfirmed && stamp - agreed_ <= kPatience) return true;
    agreements_ = agrees ? agreements_ + 1 : 0;
  }
  last_ = seen;
  agreed_ = stamp;
  return false;
}

void VanishingMemory::carry(double stamp, const ApproachAngleResult::Motion& turn) {
  const double T = stamp - stamp_;
  stamp_ = stamp;
  if (!last_) return;
  if (!AttitudeFilter::tellsTurn(turn, T)) {
    last_->covariance += std::pow(aircraft::kTurnRate * T, 2) * Eigen::Matrix3d::Identity();
    return;
  }
  const Eigen::Matrix3d R = rotationMatrix(turn.rotation);
  last_->direction = (R * last_->direction).eval();
  const Eigen::Matrix3d by_turn = crossMatrix(last_->direction);
  last_->covariance = (R * last_->covariance * R.transpose()).eval() +
                      by_turn * turn.covariance.topLeftCorner<3, 3>() * by_turn.transpose();
}

}  // namespace uav_landing
