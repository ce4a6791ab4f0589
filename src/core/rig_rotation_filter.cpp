#include "uav_landing/rig_rotation_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Seconds after which texture and lines are others.
constexpr double kCorrelationTime = 1.0;
// Vertical disparities that a good lens calibration leaves, pixels, and how far from the middle of the image,
// in focal lengths, they tell a roll.
constexpr double kLensError = 0.03, kLensReach = 0.3;
// Degrees of freedom of the Student t: the fewer, the sooner a bent rig is believed.
constexpr double kFreedom = 2.0;
// Share of the vanishing point's smallest variance seen that is not the runway's slope.
constexpr double kNoiseShare = 0.1;

}  // namespace

RigRotationFilter::RigRotationFilter(const StereoRig& rig, double memory) : rig_(rig), memory_(memory) {}

void RigRotationFilter::reset() {
  const double calibrated = calibrated_variance_;
  *this = RigRotationFilter(rig_, memory_);
  if (calibrated > 0) setPrior(std::sqrt(calibrated) * rig_.fx);
}

void RigRotationFilter::advance(double stamp) {
  constexpr double kFirstShare = 0.1;
  const double T = stamp_ ? std::max(0.0, stamp - *stamp_) : kFirstShare * kCorrelationTime;
  stamp_ = stamp;
  share_ = std::min(1.0, T / kCorrelationTime);
  const double kept = std::exp(-T / memory_);
  information_ *= kept;
  right_ *= kept;
}

void RigRotationFilter::setPrior(double bias_stddev) {
  constexpr double kExact = 1e-7;  // rad
  const double variance = std::pow(std::max(bias_stddev / rig_.fx, kExact), 2);
  if (variance == calibrated_variance_) return;
  calibrated_variance_ = variance;
  prior_.head<3>().setConstant(variance);
  prior_[3] = 1;
  prior_[4] = std::pow(kLensError / rig_.fy, 2);
  prior_[5] = std::pow(kLensError / (kLensReach * rig_.fy), 2);
  solve();
}

void RigRotationFilter::updateVertical(const RigRotation& measured) {
  if (!measured.known() || !(calibrated_variance_ > 0)) return;
  // Marginal over ry.
  Eigen::Matrix2d covariance;
  covariance << measured.covariance(0, 0), measured.covariance(0, 2), measured.covariance(2, 0),
      measured.covariance(2, 2);
  // Without a definite covariance, as in a message whose field was never filled in, it would leave no state.
  const Eigen::LLT<Eigen::Matrix2d> decomposed(covariance);
  if (!(covariance.trace() > 0) || decomposed.info() != Eigen::Success) return;
  const Eigen::Matrix2d weight = share_ * decomposed.solve(Eigen::Matrix2d::Identity());
  Eigen::Matrix<double, 2, 6> rows = Eigen::Matrix<double, 2, 6>::Zero();
  rows(0, 0) = rows(0, 4) = rows(1, 2) = rows(1, 5) = 1;
  information_ += rows.transpose() * weight * rows;
  right_ += rows.transpose() * weight * Eigen::Vector2d(measured.w.x(), measured.w.z());
  solve();
}

void RigRotationFilter::measure(const Eigen::Matrix<double, 1, 6>& row, double value, double variance) {
  information_ += share_ / variance * row.transpose() * row;
  right_ += share_ / variance * value * row.transpose();
  solve();
}

void RigRotationFilter::solve() {
  constexpr int kIterations = 3;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix6 all = information_;
    all.diagonal() += prior_.cwiseInverse();
    covariance_ = all.inverse();
    state_ = covariance_ * right_;
    for (int i = 0; i < 3; ++i) {
      prior_[i] =
          (kFreedom * calibrated_variance_ + state_[i] * state_[i] + covariance_(i, i)) / (kFreedom + 1);
    }
  }
}

void RigRotationFilter::learnSlopeVariance(double variance) {
  if (slope_variance_ > 0 && (1 - kNoiseShare) * variance >= slope_variance_) return;
  slope_variance_ = (1 - kNoiseShare) * variance;
  prior_[3] = slope_variance_;
  solve();
}

RigRotationFilter::Corrected RigRotationFilter::correct(const GroundPlane& plane, const Eigen::Matrix3d& A,
                                                        const Eigen::Vector3d& direction,
                                                        const Eigen::Matrix3d& direction_covariance,
                                                        double gate) {
  Corrected corrected;
  GroundPlane& now = corrected.plane;
  now.g = plane.g - A * state_.head<3>();
  corrected.common = A * covariance_.topLeftCorner<3, 3>() * A.transpose();
  now.covariance = plane.covariance + corrected.common;
  if (!direction.allFinite() || !direction_covariance.allFinite()) return corrected;

  const double h = now.height();
  const Eigen::Vector3d n = now.normal();
  const double total = n.dot(direction_covariance * n);
  if (!(total > 0)) return corrected;
  learnSlopeVariance(total);
  const double noise = total - slope_variance_;  // of p.n, of this frame alone

  // Jointly: 0 = p.g - s / h.
  const Eigen::Vector3d with_slope = -A * covariance_.block<3, 1>(0, 3);
  const double innovation = state_[3] / h - direction.dot(now.g);
  const double variance = direction.dot(now.covariance * direction) - 2 * direction.dot(with_slope) / h +
                          (covariance_(3, 3) + noise) / (h * h);
  const Eigen::Vector3d gain = (now.covariance * direction - with_slope / h) / variance;
  const double ratio = std::abs(innovation) / std::sqrt(variance);
  if (!(ratio >= 0)) return corrected;

  if (ratio <= gate) {
    now.g += gain * innovation;
    now.covariance -= variance * gain * gain.transpose();
    Eigen::Matrix<double, 3, 4> by_common;
    by_common << A - gain * direction.transpose() * A, -gain / h;
    corrected.common = by_common * covariance_.topLeftCorner<4, 4>() * by_common.transpose();
  }

  // For the frames to come.
  Eigen::Matrix<double, 1, 6> row = Eigen::Matrix<double, 1, 6>::Zero();
  row.head<3>() = h * direction.transpose() * A;
  row[3] = 1;
  const double of_frame = h * h * direction.dot(plane.covariance * direction) + noise;
  measure(row, h * direction.dot(plane.g), of_frame * std::max(1.0, ratio / gate));
  return corrected;
}

RigRotation RigRotationFilter::rotation() const {
  RigRotation rotation;
  if (!(calibrated_variance_ > 0)) return rotation;
  rotation.w = state_.head<3>();
  rotation.covariance = covariance_.topLeftCorner<3, 3>();
  return rotation;
}

}  // namespace uav_landing
