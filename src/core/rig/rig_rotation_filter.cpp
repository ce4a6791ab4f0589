#include "rig/rig_rotation_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "rig/rig_rotation.h"

namespace uav_landing {
namespace {

// Time after which the camera sees other texture, s.
constexpr double kCorrelationTime = 1.0;
// The same for a vanishing direction, s. The lines of a runway far ahead stay the same for longer. Their
// errors (blur, ragged paint, which lines are found) hardly change until they are seen from much nearer.
constexpr double kLinesTime = 5.0;
// Degrees of freedom of the Student t. The fewer there are, the sooner the filter believes in a bent rig.
constexpr double kFreedom = 2.0;
// Share of the vanishing point's smallest variance so far that is not due to the runway's slope.
constexpr double kNoiseShare = 0.1;
// 1 sigma of the lasting error of a normal by the images' motion, rad. Lenses scale the motion in the image a
// little. Where the ground bends, the plane that moves is not quite that of stereo.
constexpr double kMovingStddev = 0.003 * M_PI / 180;
// Share of such a normal's noise that the next pairs have, too. They see the same ground in other images.
constexpr double kMovingLasting = 0.05;
// Larger squared normalised innovations of such a normal count as this one.
constexpr double kMovingLimit = 25;

}  // namespace

RigRotationFilter::RigRotationFilter(const StereoRig& rig, double memory)
    : rig_(rig), memory_(memory), moving_scatter_(kMovingLimit) {
  prior_.tail<2>().setConstant(kMovingStddev * kMovingStddev);
}

void RigRotationFilter::reset() {
  const double calibrated = calibrated_variance_, row_bias = row_bias_stddev_;
  *this = RigRotationFilter(rig_, memory_);
  if (calibrated > 0) setPrior(std::sqrt(calibrated) * rig_.fx, row_bias);
}

void RigRotationFilter::startAnew(const RigRotation& vertical) {
  const std::optional<double> stamp = stamp_;
  reset();
  stamp_ = stamp;
  share_ = 1;
  updateVertical(vertical);
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

void RigRotationFilter::setPrior(double bias_stddev, double row_bias_stddev) {
  constexpr double kExact = 1e-7;  // rad
  const double variance = std::pow(std::max(bias_stddev / rig_.fx, kExact), 2);
  if (variance == calibrated_variance_ && row_bias_stddev == row_bias_stddev_) return;
  calibrated_variance_ = variance;
  row_bias_stddev_ = row_bias_stddev;
  prior_.head<3>().setConstant(variance);
  const Eigen::Vector3d lens = lensVariances(rig_, row_bias_stddev).array() + kExact * kExact;
  prior_[4] = lens.x();
  prior_[5] = lens.z();
  solve();
}

void RigRotationFilter::updateVertical(const RigRotation& measured) {
  if (!measured.known() || !(calibrated_variance_ > 0)) return;
  const Eigen::Matrix2d covariance = measured.pitchAndRollCovariance();
  // A covariance that is not definite would make the state useless. A message whose field was never filled in
  // has one.
  const Eigen::LLT<Eigen::Matrix2d> decomposed(covariance);
  if (!(covariance.trace() > 0) || decomposed.info() != Eigen::Success) return;
  const Eigen::Matrix2d weight = share_ * decomposed.solve(Eigen::Matrix2d::Identity());
  Eigen::Matrix<double, 2, kSize> rows = Eigen::Matrix<double, 2, kSize>::Zero();
  rows(0, 0) = rows(0, 4) = rows(1, 2) = rows(1, 5) = 1;
  information_ += rows.transpose() * weight * rows;
  right_ += rows.transpose() * weight * measured.pitchAndRoll();
  solve();
}

void RigRotationFilter::solve() {
  constexpr int kIterations = 3;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix all = information_;
    all.diagonal() += prior_.cwiseInverse();
    covariance_ = all.inverse();
    state_ = covariance_ * right_;
    for (int i = 0; i < 3; ++i) {
      prior_[i] =
          (kFreedom * calibrated_variance_ + state_[i] * state_[i] + covariance_(i, i)) / (kFreedom + 1);
    }
  }
}

double RigRotationFilter::learnSlopeVariance(int slope, double variance) {
  double& smallest = slope_variance_[slope];
  if (!(smallest > 0) || (1 - kNoiseShare) * variance < smallest) {
    smallest = prior_[slope] = (1 - kNoiseShare) * variance;
    solve();
  }
  return smallest;
}

// Innovation of the measurement 0 = p.g - s / h, with the errors of the state, the plane and p.
RigRotationFilter::Innovation RigRotationFilter::innovationOf(const Sloping& sloping, double noise,
                                                              const Joint& joint) const {
  const Eigen::Vector3d& p = sloping.ground.vector();
  const double h = joint.plane.height();
  Innovation innovation;
  innovation.value = state_[sloping.slope] / h - p.dot(joint.plane.g);
  const Eigen::Matrix3d all =
      joint.plane.covariance + joint.by_state * covariance_ * joint.by_state.transpose();
  const Eigen::Vector3d with_slope = joint.by_state * covariance_.col(sloping.slope);
  innovation.variance = p.dot(all * p) - 2 * p.dot(with_slope) / h +
                        (covariance_(sloping.slope, sloping.slope) + noise) / (h * h);
  innovation.gain = (all * p - with_slope / h) / innovation.variance;
  return innovation;
}

void RigRotationFilter::fuse(const Sloping& sloping, double noise, const Innovation& innovation,
                             Joint& joint) const {
  const Eigen::Vector3d& gain = innovation.gain;
  const double h = joint.plane.height();
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain * sloping.ground.vector().transpose();
  const Eigen::Matrix3d by_noise = noise / (h * h) * gain * gain.transpose();
  joint.plane.g += gain * innovation.value;
  joint.plane.covariance = kept * joint.plane.covariance * kept.transpose() + by_noise;
  joint.by_state = (kept * joint.by_state).eval();
  joint.kept = (kept * joint.kept).eval();
  joint.by_state.col(sloping.slope) += gain / h;
  joint.lasting = (kept * joint.lasting * kept.transpose()).eval();
  if (sloping.isMoving()) joint.lasting += kMovingLasting * by_noise;
}

std::vector<RigRotationFilter::Sloping> RigRotationFilter::directionsOf(const Others& others) {
  std::vector<Sloping> directions;
  if (others.vanishing) directions.push_back({*others.vanishing, kVanishing});
  const auto addNormal = [&](const std::optional<GroundNormal>& ground, int slope) {
    if (!ground) return;
    for (const GroundDirection& direction : levelDirections(*ground))
      directions.push_back({direction, slope++});
  };
  addNormal(others.level, kLevel);
  addNormal(others.moving, kMoving);
  return directions;
}

// Variance of a direction without that of its slope.
double RigRotationFilter::noiseOf(const Sloping& sloping, double variance, const Joint& joint) {
  if (!sloping.isMoving()) return variance - learnSlopeVariance(sloping.slope, variance);
  // On uneven ground such normals scatter by more than the residuals of the points show, because the points
  // have common errors there.
  const Innovation innovation = innovationOf(sloping, variance, joint);
  moving_scatter_.add(innovation.value * innovation.value / innovation.variance);
  return moving_scatter_.factor() * variance;
}

void RigRotationFilter::Equations::add(const Eigen::RowVector3d& tip, const GroundPlane& plane,
                                       const Eigen::Matrix3d& A, int slope, double noise, double inflation) {
  const Eigen::Index i = rows.rows();
  rows.conservativeResize(i + 1, kSize);
  tips.conservativeResize(i + 1, 3);
  values.conservativeResize(i + 1);
  noises.conservativeResize(i + 1);
  inflations.conservativeResize(i + 1);
  tips.row(i) = tip;
  rows.row(i).setZero();
  rows.row(i).head<3>() = tips.row(i) * A;
  rows(i, slope) = 1;
  values[i] = tips.row(i) * plane.g;
  noises[i] = noise;
  inflations[i] = inflation;
}

void RigRotationFilter::settle(bool believed) {
  const Equations all = std::exchange(of_last_pair_, {});
  if (!believed || all.values.size() == 0) return;
  Eigen::MatrixXd of_frame = all.tips * all.plane_covariance * all.tips.transpose();
  of_frame.diagonal() += all.noises;
  of_frame = (all.inflations.asDiagonal() * of_frame * all.inflations.asDiagonal()).eval();
  const Eigen::MatrixXd weighted = share_ * of_frame.llt().solve(all.rows);
  information_ += all.rows.transpose() * weighted;
  right_ += weighted.transpose() * all.values;
  solve();
}

RigRotationFilter::Corrected RigRotationFilter::correct(const GroundPlane& plane, const Eigen::Matrix3d& A,
                                                        const Others& others, double gate) {
  Joint joint{plane, Eigen::Matrix<double, 3, kSize>::Zero(), Eigen::Matrix3d::Identity(),
              Eigen::Matrix3d::Zero()};
  joint.plane.g = plane.g - A * state_.head<3>();
  joint.by_state.leftCols<3>() = -A;
  const double h = joint.plane.height();
  of_last_pair_ = {};
  of_last_pair_.plane_covariance = plane.covariance;
  for (const Sloping& sloping : directionsOf(others)) {
    const Eigen::Vector3d n = joint.plane.normal();
    const double total = n.dot(sloping.ground.covariance() * n);
    if (!(total > 0)) continue;
    const double noise = noiseOf(sloping, total, joint);
    const Innovation innovation = innovationOf(sloping, noise, joint);
    const double ratio = std::abs(innovation.value) / std::sqrt(innovation.variance);
    if (!(ratio >= 0)) continue;
    if (ratio <= gate) fuse(sloping, noise, innovation, joint);
    const double lasting = sloping.slope == kVanishing ? kLinesTime / kCorrelationTime : 1.0;
    of_last_pair_.add(h * sloping.ground.vector().transpose(), plane, A, sloping.slope, noise,
                      std::sqrt(std::max(1.0, ratio / gate) * lasting));
  }
  Corrected corrected;
  corrected.plane = joint.plane;
  corrected.kept = joint.kept;
  corrected.common = joint.by_state * covariance_ * joint.by_state.transpose();
  corrected.plane.covariance += corrected.common;
  corrected.common += joint.lasting;
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
