#include "integrity/memory/velocity_memory.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimation/aircraft.h"

namespace uav_landing {
namespace {

constexpr int kConfirmed = 3;

VelocityMemory::Innovation measuredBy(const VelocityMemory::Step& step) {
  const Eigen::Vector3d velocity = step.way / step.duration;
  return {velocity, step.covariance / (step.duration * step.duration) +
                        step.stamp_variance * velocity * velocity.transpose()};
}

}  // namespace

std::optional<VelocityMemory::Innovation> VelocityMemory::follow(const Step& step) {
  since_contradiction_ += step.duration;
  velocity_before_ = velocity_;
  covariance_before_ = covariance_;
  velocity_ = step.rotation * velocity_;
  covariance_ = (step.rotation * covariance_ * step.rotation.transpose()).eval();
  covariance_.diagonal().array() += std::pow(aircraft::kAcceleration * step.duration, 2);
  if (agreements_ < kConfirmed) return std::nullopt;
  const Innovation measured = measuredBy(step);
  return Innovation{measured.difference - velocity_, covariance_ + measured.covariance + lasting()};
}

void VelocityMemory::learn(const Step& step, bool agrees) {
  const Innovation measured = measuredBy(step);
  const Eigen::Vector3d difference = measured.difference - velocity_;
  if (agreements_ < kConfirmed) {
    // Nothing tells yet which of two steps is wrong.
    constexpr double kAgreement = 16.3;  // chi-square limit of 1e-3 with three degrees of freedom
    const Eigen::Matrix3d sum = covariance_ + measured.covariance;
    if (agreements_ == 0 || !(difference.dot(sum.ldlt().solve(difference)) <= kAgreement))
      return restart(step);
    ++agreements_;
  } else if (!agrees) {
    since_contradiction_ = agreed_ = 0;
    contradicted_ += step.duration;
    // The rotation of this step is not believed, either.
    velocity_ = velocity_before_;
    covariance_ = covariance_before_;
    return carryOn(step.duration);
  }
  covariance_ += lasting();
  contradicted_ = 0;
  agreed_ += step.duration;
  const Eigen::Matrix3d gain = covariance_ * (covariance_ + measured.covariance).inverse();
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain;
  velocity_ += gain * difference;
  covariance_ =
      (kept * covariance_ * kept.transpose() + gain * measured.covariance * gain.transpose()).eval();
}

Eigen::Matrix3d VelocityMemory::lasting() const {
  return std::pow(aircraft::kLastingAcceleration * contradicted_, 2) * Eigen::Matrix3d::Identity();
}

void VelocityMemory::restart(const Step& step) {
  const Innovation measured = measuredBy(step);
  velocity_ = measured.difference;
  covariance_ = measured.covariance;
  agreements_ = 1;
  contradicted_ = 0;
}

void VelocityMemory::skip(double duration) {
  since_contradiction_ += duration;
  if (contradicted_ > 0) contradicted_ += duration;
  carryOn(duration);
}

void VelocityMemory::carryOn(double duration) {
  covariance_.diagonal().array() += std::pow(aircraft::kAcceleration * duration, 2);
  const double turn = aircraft::kTurnRate * duration;
  covariance_ += turn * turn *
                 (velocity_.squaredNorm() * Eigen::Matrix3d::Identity() - velocity_ * velocity_.transpose());
}

}  // namespace uav_landing
