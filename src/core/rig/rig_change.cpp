#include "rig/rig_change.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kMemory = 2.0;     // s, time over which the mean is taken
constexpr double kFirst = 0.4;      // s, needed before there is anything to compare with
constexpr double kFirstTime = 0.1;  // s, largest time that the first pair of a mean counts for
constexpr double kPatience = 3.0;   // s of another rotation, after which it may be the rig's
constexpr double kSettled = 1.0;    // s without a change, after which a rotation is the rig's
// Rotation that does little harm, rad. Images that are not synchronised and show it change the height by at
// most 0.1 %.
constexpr double kSmall = 0.1 * M_PI / 180;
constexpr double kSame = 13.8;                 // chi-square limit of 1e-3 with two degrees of freedom
constexpr double kMostDisorder = 2.0;          // largest stddev of a pair over that of the pairs before
constexpr double kFloor = 0.004 * M_PI / 180;  // rad, 1 sigma, for scenes whose depth affects the rows

Eigen::Matrix2d covarianceOf(const RigRotation& rotation) {
  return rotation.pitchAndRollCovariance() + kFloor * kFloor * Eigen::Matrix2d::Identity();
}

}  // namespace

bool RigChange::Innovation::agrees() const {
  return difference.dot(covariance.inverse() * difference) <= kSame;
}

bool RigChange::Innovation::isLarge() const { return difference.norm() > kSmall && !agrees(); }

RigChange::Innovation RigChange::Mean::compare(const RigRotation& measured) const {
  // The covariance has errors that neighbouring rows share, estimated from few parts of one image. When it is
  // small by chance, the mean's covariance is used. When it is large, it is limited: images of two different
  // scenes must not pass because of the disorder that they cause.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> against(covarianceOf(measured), covariance);
  const Eigen::Vector2d ratios = against.eigenvalues().cwiseMax(1).cwiseMin(kMostDisorder * kMostDisorder);
  const Eigen::Matrix2d axes = covariance * against.eigenvectors();
  return {measured.pitchAndRoll() - value, covariance + axes * ratios.asDiagonal() * axes.transpose()};
}

void RigChange::Mean::add(double T, const RigRotation& measured) {
  const double share = learned > 0 ? std::clamp(T / std::min(learned + T, kMemory), 0.0, 1.0) : 1.0;
  value += share * (measured.pitchAndRoll() - value);
  // Pairs in a row see the same texture, so their mean is not better than the best of them.
  covariance += share * (covarianceOf(measured) - covariance);
  // Nobody knows for how long the rotation had been this one before the first pair.
  learned += std::clamp(T, 1e-3, learned > 0 ? kMemory : kFirstTime);
}

std::optional<RigChange::Innovation> RigChange::compare(const RigRotation& measured) const {
  if (!measured.known() || mean_.learned < kFirst) return std::nullopt;
  return mean_.compare(measured);
}

bool RigChange::doubts(const RigRotation& measured) const {
  if (!settled()) return true;
  const std::optional<Innovation> off = compare(measured);
  const bool stayed = other_.learned >= kSettled && other_.compare(measured).agrees();
  return off && off->isLarge() && !stayed;
}

bool RigChange::settled() const { return !anew_ || mean_.learned >= kSettled; }

void RigChange::learnOther(double T, const RigRotation& measured) {
  if (other_.learned > 0) {
    if (!other_.compare(measured).agrees()) other_ = {};
  }
  other_.add(T, measured);
}

bool RigChange::learn(double T, const RigRotation& measured, bool agrees) {
  if (!measured.known()) return false;
  if (!agrees) {
    disagreed_ += T;
    learnOther(T, measured);
    if (other_.learned >= kSettled && (other_.value - mean_.value).norm() <= kSmall) {
      mean_ = other_;
      other_ = {};
      disagreed_ = 0;
      return true;
    }
    if (settled() && disagreed_ < kPatience) return false;
    reset();
    anew_ = true;
  }
  other_ = {};
  disagreed_ = 0;
  const bool settling = !settled();
  mean_.add(T, measured);
  return settling && settled();
}

RigRotation RigChange::mean() const {
  RigRotation rotation;
  rotation.w = {mean_.value.x(), 0, mean_.value.y()};
  rotation.covariance.setIdentity();  // the yaw is not known
  rotation.covariance(0, 0) = mean_.covariance(0, 0);
  rotation.covariance(2, 2) = mean_.covariance(1, 1);
  rotation.covariance(0, 2) = rotation.covariance(2, 0) = mean_.covariance(0, 1);
  return rotation;
}

}  // namespace uav_landing
