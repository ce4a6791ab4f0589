#include "height/height_filter.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr int kBaseline = 3;  // column of this cause in common_

Eigen::RowVector4d stddevs(const CommonVariance& common) {
  return Eigen::RowVector4d(common.lasting, common.bend, common.width, common.baseline)
      .cwiseMax(0)
      .cwiseSqrt();
}

}  // namespace

HeightFilter::HeightFilter(double acceleration_stddev, double initial_speed_stddev, double gate)
    : acceleration_stddev_(acceleration_stddev), initial_speed_stddev_(initial_speed_stddev), gate_(gate) {}

void HeightFilter::initialise(double height, double variance, const CommonVariance& common) {
  state_ << height, 0;
  covariance_ << variance, 0, 0, initial_speed_stddev_ * initial_speed_stddev_;
  own_ = covariance_;
  own_(0, 0) = std::max(0.0, variance - common.total());
  common_ << stddevs(common), Eigen::RowVector4d::Zero();
  initialised_ = true;
}

void HeightFilter::predict(double T) {
  Eigen::Matrix2d transition;
  transition << 1, T, 0, 1;
  const Eigen::Vector2d noise_gain(0.5 * T * T, T);
  state_ = transition * state_;
  const Eigen::Matrix2d noise =
      acceleration_stddev_ * acceleration_stddev_ * noise_gain * noise_gain.transpose();
  covariance_ = transition * covariance_ * transition.transpose() + noise;
  own_ = transition * own_ * transition.transpose() + noise;
  common_ = transition * common_;
}

HeightFilter::Update HeightFilter::update(double height, double variance, const CommonVariance& common) {
  // A height by a known width does not depend on the baseline, but one from the images does.
  const double unequal = common_(0, kBaseline) - stddevs(common)[kBaseline];
  return fuse(Eigen::RowVector2d(1, 0), height, variance, common, unequal * unequal);
}

HeightFilter::Update HeightFilter::updateSpeed(double speed, double variance) {
  return fuse(Eigen::RowVector2d(0, 1), speed, variance, {}, 0);
}

CommonVariance HeightFilter::commonVariance() const {
  const Eigen::RowVector4d squares = common_.row(0).cwiseAbs2();
  return {squares[0], squares[1], squares[2], squares[3]};
}

HeightFilter::Update HeightFilter::fuse(const Eigen::RowVector2d& observation, double measured,
                                        double variance, const CommonVariance& common,
                                        double baseline_variance) {
  Update update;
  update.innovation = measured - observation * state_;
  update.innovation_variance = (observation * covariance_ * observation.transpose()).value() + variance;
  update.gate_variance = update.innovation_variance + baseline_variance;
  // Written so that NaN is refused, too. An infinite or negative variance would destroy the state.
  update.accepted = variance >= 0 && std::isfinite(common.total()) && std::isfinite(update.gate_variance) &&
                    update.innovation * update.innovation <= gate_ * gate_ * update.gate_variance;
  if (!update.accepted) return update;

  const Eigen::Vector2d gain = covariance_ * observation.transpose() / update.innovation_variance;
  state_ += gain * update.innovation;
  const Eigen::Matrix2d remaining = Eigen::Matrix2d::Identity() - gain * observation;
  covariance_ = remaining * covariance_ * remaining.transpose() + variance * gain * gain.transpose();
  own_ = remaining * own_ * remaining.transpose() +
         std::max(0.0, variance - common.total()) * gain * gain.transpose();
  common_ = remaining * common_ + gain * stddevs(common);
  return update;
}

}  // namespace uav_landing
