#include "motion/path/motion_description.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"
#include "motion/path/approach_angle.h"
#include "results/any_angle.h"

namespace uav_landing {
namespace {

double sineOfAngle(const MotionEstimate& estimate) {
  return estimate.normal.normalized().dot(estimate.motion.t.normalized());
}

// Gradient of n.t/|t| by t and n.
Eigen::Matrix<double, 6, 1> sineGradient(const MotionEstimate& estimate) {
  const Eigen::Vector3d& t = estimate.motion.t;
  const Eigen::Vector3d n = estimate.normal.normalized();
  const Eigen::Vector3d m = t.normalized();
  const double sine = n.dot(m);
  Eigen::Matrix<double, 6, 1> gradient;
  gradient << (n - sine * m) / t.norm(), m - sine * n;
  return gradient;
}

// Variance of the angle asin(n.t/|t|) from a covariance of t and n.
double angleVariance(const MotionEstimate& estimate, const Eigen::Matrix<double, 9, 9>& covariance) {
  const double sine = sineOfAngle(estimate);
  const Eigen::Matrix<double, 6, 1> gradient = sineGradient(estimate);
  return gradient.dot(covariance.bottomRightCorner<6, 6>() * gradient) / (1 - sine * sine);
}

// Effect of 1 sigma of an estimated readout time on the angle, rad.
double angleByReadout(const MotionEstimate& estimate, const ReadoutEstimate& readout) {
  if (!readout.known()) return 0;
  const double by_time = sineGradient(estimate).dot(estimate.readout.by_time.tail<6>());
  return std::sqrt(readout.variance) * by_time / std::sqrt(1 - std::pow(sineOfAngle(estimate), 2));
}

// Sets how much rows that move on their own move the angle. The size of the effect is known only roughly,
// because the matches cannot tell a slow shake from a motion.
void setRowMotion(const MotionEstimate& estimate, ApproachAngleResult::Motion& motion) {
  constexpr double kSmallPart = 1.0 / 3;  // of 1 sigma
  motion.row_motion = std::sqrt(angleVariance(estimate, estimate.of_shake));
  motion.row_motion_limit = kSmallPart * std::sqrt(motion.angle_variance);
}

double largestEigenvalue(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

}  // namespace

void claimReadout(const ReadoutEstimate& readout, MotionEstimate& estimate) {
  if (!readout.known()) return;
  const ReadoutEffect& effect = estimate.readout;
  estimate.covariance += readout.variance * effect.by_time * effect.by_time.transpose();
  estimate.own_normal_covariance +=
      readout.variance * effect.own_normal_by_time * effect.own_normal_by_time.transpose();
}

MotionDescription describe(const Expected<MotionEstimate>& estimate, const MotionFacts& facts) {
  MotionDescription described;
  ApproachAngleResult::Motion& motion = described.motion;
  motion.duration = facts.duration;
  motion.matches = static_cast<int>(facts.matches);
  if (!estimate) {
    motion.failure = estimate.error();
    return described;
  }
  motion.inliers = estimate->inlier_count;
  motion.rotation = rotationVector(estimate->motion.R);
  motion.translation_over_height = estimate->motion.t;
  MotionEstimate claimed = *estimate;
  claimReadout(facts.readout, claimed);
  motion.covariance = claimed.covariance.topLeftCorner<6, 6>();
  motion.normal = claimed.own_normal;
  motion.normal_covariance = claimed.own_normal_covariance;
  const double uncertainty = std::sqrt(largestEigenvalue(estimate->covariance.block<3, 3>(3, 3)));
  if (estimate->motion.t.norm() < facts.min_motion * uncertainty) {
    motion.failure = {Reason::kNoMotion, "the movement is not larger than its own uncertainty"};
    return described;
  }
  motion.angle = approachAngle(estimate->normal.normalized(), estimate->motion.t);
  motion.angle_variance = angleVariance(*estimate, claimed.covariance);
  const double of_normal = angleVariance(*estimate, estimate->of_normal);
  const double of_matches = angleVariance(*estimate, estimate->covariance) - of_normal;
  if (facts.may_roll) setRowMotion(*estimate, motion);
  const bool shaken = motion.rowsMove();
  described.angle = {motion.angle,
                     std::max(of_matches, 0.0),
                     facts.duration,
                     std::sqrt(of_normal),
                     angleByReadout(*estimate, facts.readout),
                     shaken,
                     facts.rolling};
  if (shaken) motion.angle_variance = kAnyAngle * kAnyAngle;
  return described;
}

}  // namespace uav_landing
