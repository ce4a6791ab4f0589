#include "motion/step/row_rates.h"

#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"

namespace uav_landing {
namespace {

constexpr double kOfStep = 0.2 * M_PI / 180;  // 1 sigma of the rate by the images over a step, rad/s
constexpr double kLongestAhead = 0.1;         // s, for which an acceleration is taken to last
constexpr double kKept = 0.98;                // share of the sums that is left at the next step

}  // namespace

void GyroBias::add(const Eigen::Vector3d& off) {
  steps_ = kKept * steps_ + 1;
  sum_ = kKept * sum_ + off;
}

Eigen::Vector3d GyroBias::mean() const { return sum_ / (steps_ + stepsBeforehand()); }

double GyroBias::stepsBeforehand() const { return kOfStep * kOfStep / (stddev_ * stddev_); }

double GyroBias::variance() const { return kOfStep * kOfStep / (steps_ + stepsBeforehand()); }

void GyroDelay::add(const DelayEffect& effect, double duration) {
  constexpr double kMost = 5e-3;    // s: beyond it, the effect is not linear
  constexpr double kChange = 1e-4;  // 1 sigma of its change within a second, s
  if (!(effect.information > 0) || !std::isfinite(effect.score)) return;
  const double information = 1 / (variance_ + kChange * kChange * duration) + effect.information;
  late_ = std::clamp(late_ + effect.score / information, -kMost, kMost);
  variance_ = 1 / information;
}

void RowRates::see(const AttitudePrior& imu) { now_ = imu; }

void RowRates::setRate(const AttitudePrior& imu, RowMotion& motion) const {
  motion.w = meanRate(imu);
  motion.a.setZero();
  motion.beyond = gyroOf(imu);
}

StepEnds RowRates::ends(const CameraMotion& step, double duration, double height_then) const {
  StepEnds ends = history_.ends(step, duration, height_then);
  // Vibration that both images have alike does no harm. It would, taken out of one of them alone.
  if (!measured()) return ends;
  setRate(then_, ends.then);
  setRate(now_, ends.now);
  return ends;
}

std::optional<Eigen::Vector3d> RowRates::measuredNow() const {
  if (!now_.rows) return std::nullopt;
  return meanRate(now_);
}

RowMotion RowRates::expected(const RowMotion& last, double age, const AttitudePrior& imu) const {
  RowMotion motion = last;
  if (imu.rows) {
    setRate(imu, motion);
    return motion;
  }
  motion.w += std::min(std::max(age, 0.0), kLongestAhead) * motion.a;
  motion.beyond = {};
  return motion;
}

RowDoubt RowRates::doubt(double duration, double readout) const {
  RowDoubt doubt;
  if (!measured()) {
    doubt.turn = readout * readout * history_.doubt(duration);
    return doubt;
  }
  doubt.turn =
      readout * readout *
      (then_.rows->covariance() + now_.rows->covariance() + bias_.variance() * Eigen::Matrix3d::Identity());
  doubt.delay = {delay_.variance(), gyroOf(then_), gyroOf(now_), readout};
  return doubt;
}

void RowRates::add(const CameraMotion& step, double duration, const DelayEffect& effect) {
  constexpr double kStampRounding = 1e-3;  // s
  history_.add(step, duration);
  if (measured()) {
    delay_.add(effect, duration);
    if (now_.hasRotation() && std::abs(now_.duration - duration) < kStampRounding)
      bias_.add((rotationVector(step.R) - now_.rotation) / duration);
  }
  then_ = now_;
  now_ = {};
}

void RowRates::skip() {
  history_.interrupt();
  then_ = now_;
  now_ = {};
}

}  // namespace uav_landing
