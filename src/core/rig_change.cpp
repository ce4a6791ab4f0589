#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "uav_landing/consistency_tests.h"

namespace uav_landing {
namespace {

constexpr double kMemory = 2.0;                // s that the mean is of
constexpr double kFirst = 0.4;                 // s before there is anything to compare with
constexpr double kPatience = 3.0;              // s of something else, after which that may be the rig
constexpr double kSettled = 1.0;               // s of it without a change, after which it is
constexpr double kMostDisorder = 2.0;          // stddev of a pair over that of the pairs before
constexpr double kFloor = 0.004 * M_PI / 180;  // rad, 1 sigma: scenes whose depth pulls at the rows

Eigen::Vector2d value(const RigRotation& rotation) { return {rotation.w.x(), rotation.w.z()}; }

Eigen::Matrix2d covariance(const RigRotation& rotation) {
  Eigen::Matrix2d result;
  result << rotation.covariance(0, 0), rotation.covariance(0, 2), rotation.covariance(2, 0),
      rotation.covariance(2, 2);
  return result + kFloor * kFloor * Eigen::Matrix2d::Identity();
}

}  // namespace

std::optional<RigChange::Innovation> RigChange::compare(const RigRotation& measured) const {
  if (!measured.known() || learned_ < kFirst) return std::nullopt;
  // What neighbouring rows share is estimated from few parts of one image: where it is small by chance, the
  // pairs before know better, and where it is large, images of two scenes must not be excused by the disorder
  // they make.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> against(covariance(measured), covariance_);
  const Eigen::Vector2d ratios = against.eigenvalues().cwiseMax(1).cwiseMin(kMostDisorder * kMostDisorder);
  const Eigen::Matrix2d axes = covariance_ * against.eigenvectors();
  return Innovation{value(measured) - mean_, covariance_ + axes * ratios.asDiagonal() * axes.transpose()};
}

bool RigChange::settled() const { return !anew_ || learned_ >= kSettled; }

void RigChange::learn(double T, const RigRotation& measured, bool agrees) {
  if (!measured.known()) return;
  if (!agrees) {
    disagreed_ += T;
    if (settled() && disagreed_ < kPatience) return;
    reset();
    anew_ = true;
  }
  disagreed_ = 0;
  const double share = learned_ > 0 ? std::clamp(T / std::min(learned_ + T, kMemory), 0.0, 1.0) : 1.0;
  mean_ += share * (value(measured) - mean_);
  // Pairs in a row see the same texture: their mean is not better than the best of them.
  covariance_ += share * (covariance(measured) - covariance_);
  learned_ += T > 0 ? T : 1e-3;
}

}  // namespace uav_landing
