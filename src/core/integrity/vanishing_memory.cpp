#include "uav_landing/integrity/vanishing_memory.h"

#include <cmath>

#include "geometry/rotation.h"
#include "uav_landing/height/attitude_filter.h"

namespace uav_landing {
namespace {

constexpr int kConfirmed = 3;
constexpr double kPatience = 1.0;  // s, without one that agrees
constexpr double kGate = 25.0;     // squared sigmas

}  // namespace

bool VanishingMemory::leaps(double stamp, const Eigen::Vector3d& direction, const Eigen::Matrix3d& covariance,
                            const Eigen::Vector3d& normal, const ApproachAngleResult::Motion& turn) {
  carry(stamp, turn);
  if (!direction.allFinite() || !covariance.allFinite() || !normal.allFinite()) return false;
  if (last_) {
    const double off = normal.dot(direction - last_->direction);
    const double variance = normal.dot((covariance + last_->covariance) * normal);
    const bool agrees = off * off <= kGate * variance;
    if (!agrees && agreements_ >= kConfirmed && stamp - agreed_ <= kPatience) return true;
    agreements_ = agrees ? agreements_ + 1 : 0;
  }
  last_ = Direction{direction, covariance};
  agreed_ = stamp;
  return false;
}

void VanishingMemory::carry(double stamp, const ApproachAngleResult::Motion& turn) {
  const double T = stamp - stamp_;
  stamp_ = stamp;
  if (!last_) return;
  if (!AttitudeFilter::tellsTurn(turn, T)) {
    last_->covariance += std::pow(AttitudeFilter::kTurnRate * T, 2) * Eigen::Matrix3d::Identity();
    return;
  }
  const Eigen::Matrix3d R = rotationMatrix(turn.rotation);
  last_->direction = (R * last_->direction).eval();
  const Eigen::Matrix3d by_turn = crossMatrix(last_->direction);
  last_->covariance = (R * last_->covariance * R.transpose()).eval() +
                      by_turn * turn.covariance.topLeftCorner<3, 3>() * by_turn.transpose();
}

}  // namespace uav_landing
