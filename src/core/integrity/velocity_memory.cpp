#include "uav_landing/integrity/velocity_memory.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr int kConfirmed = 3;
// 1 sigma of the random acceleration, m/s^2: half a g, as in gusts and when the wheels touch down.
constexpr double kAcceleration = 5.0;
// The same of one that lasts, while steps contradict: a test's limit of some 5 sigma is 1 g then, more than
// an aircraft gains or loses in that time.
constexpr double kLasting = 1.8;
// The same of the turn where no step tells it, rad/s.
constexpr double kTurnRate = 5 * M_PI / 180;

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
  covariance_.diagonal().array() += std::pow(kAcceleration * step.duration, 2);
  if (agreements_ < kConfirmed) return std::nullopt;
  const Innovation measured = measuredBy(step);
  return Innovation{measured.difference - velocity_, covariance_ + measured.covariance + lasting()};
}

void VelocityMemory::learn(const Step& step, bool agrees) {
  const Innovation measured = measuredBy(step);
  const Eigen::Vector3d difference = measured.difference - velocity_;
  if (agreements_ < kConfirmed) {
    // Nothing yet says which of two is wrong.
    constexpr double kAgreement = 16.3;  // chi-square of three, but for one in a thousand
    const Eigen::Matrix3d sum = covariance_ + measured.covariance;
    if (agreements_ == 0 || !(difference.dot(sum.ldlt().solve(difference)) <= kAgreement))
      return restart(step);
    ++agreements_;
  } else if (!agrees) {
    since_contradiction_ = 0;
    contradicted_ += step.duration;
    // Nor is its turn believed.
    velocity_ = velocity_before_;
    covariance_ = covariance_before_;
    return carryOn(step.duration);
  }
  covariance_ += lasting();
  contradicted_ = 0;
  const Eigen::Matrix3d gain = covariance_ * (covariance_ + measured.covariance).inverse();
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain;
  velocity_ += gain * difference;
  covariance_ =
      (kept * covariance_ * kept.transpose() + gain * measured.covariance * gain.transpose()).eval();
}

Eigen::Matrix3d VelocityMemory::lasting() const {
  return std::pow(kLasting * contradicted_, 2) * Eigen::Matrix3d::Identity();
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
  covariance_.diagonal().array() += std::pow(kAcceleration * duration, 2);
  const double turn = kTurnRate * duration;
  covariance_ += turn * turn *
                 (velocity_.squaredNorm() * Eigen::Matrix3d::Identity() - velocity_ * velocity_.transpose());
}

}  // namespace uav_landing
