#include "motion/path/approach_angle.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kFocal = 500;

/// Down direction seen by a camera that looks down by `a` and is rolled right side down by `roll`.
Eigen::Vector3d downward(double a, double roll) {
  const Eigen::Vector3d level(0, std::cos(a), std::sin(a));
  return Eigen::AngleAxisd(-roll, Eigen::Vector3d::UnitZ()) * level;
}

/// Height in pixels, above the field-of-view centre, at which the vanishing line crosses the centre column.
double vanishingLineHeight(const Eigen::Vector3d& n) { return kFocal * n.z() / n.y(); }

TEST(ApproachAngle, IsTheAngleBetweenPathAndGround) {
  // 3 m forward along the ground for each metre of descent, in a frame turned arbitrarily.
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.9, 0.2, -0.3, 0.1).normalized();
  const Eigen::Vector3d n = turn * Eigen::Vector3d(0, 0, -1);
  EXPECT_NEAR(approachAngle(n, turn * Eigen::Vector3d(3, 0, -1)), std::atan2(1, 3), 1e-14);
  EXPECT_NEAR(approachAngle(n, turn * Eigen::Vector3d(0, 6, 2)), -std::atan2(1, 3), 1e-14);
  EXPECT_NEAR(approachAngle(n, n * 5), M_PI / 2, 1e-14);
}

TEST(ApproachAngle, Eq1EqualsTheGeneralFormAtZeroRollWithFoeOnTheCentreVertical) {
  for (const double a : {-3.0, 0.0, 5.0, 12.0, 25.0})
    for (const double e : {-15.0, -4.0, 0.0, 6.0}) {
      const Eigen::Vector3d n = downward(a * kDegree, 0);
      const double L = kFocal * std::tan(e * kDegree);
      const Eigen::Vector3d t(0, -L / kFocal, 1);
      EXPECT_NEAR(approachAngleEq1(vanishingLineHeight(n), L, kFocal), approachAngle(n, t), 1e-15);
      EXPECT_NEAR(approachAngle(n, t), (a - e) * kDegree, 1e-15);
    }
}

TEST(ApproachAngle, Eq1DiffersWithDriftByWhatGeometrySays) {
  // With the FOE s f to the side, the path is longer for the same descent:
  // sin(theta) = sin(a - e) / sqrt(1 + s^2 cos^2(e)), while eq (1) still says a - e.
  const double a = 12 * kDegree, e = 2 * kDegree, s = std::tan(20 * kDegree);
  const Eigen::Vector3d n = downward(a, 0), t(s, -std::tan(e), 1);
  const double general = std::asin(std::sin(a - e) / std::sqrt(1 + std::pow(s * std::cos(e), 2)));
  const double eq1 = approachAngleEq1(vanishingLineHeight(n), kFocal * std::tan(e), kFocal);
  EXPECT_NEAR(approachAngle(n, t), general, 1e-14);
  EXPECT_NEAR(eq1 - approachAngle(n, t), (a - e) - general, 1e-14);
  EXPECT_GT(eq1 - general, 0.5 * kDegree);
}

TEST(ApproachAngle, Eq1DiffersWithRollByWhatGeometrySays) {
  // Rolled by phi, the vanishing line crosses the centre column at f tan(a) / cos(phi), and
  // sin(theta) = cos(e) sin(a) - sin(e) cos(a) cos(phi).
  const double a = 12 * kDegree, e = 5 * kDegree, roll = 25 * kDegree;
  const Eigen::Vector3d n = downward(a, roll), t(0, -std::tan(e), 1);
  const double general = std::asin(std::cos(e) * std::sin(a) - std::sin(e) * std::cos(a) * std::cos(roll));
  const double expected_eq1 = std::atan(std::tan(a) / std::cos(roll)) - e;
  const double eq1 = approachAngleEq1(vanishingLineHeight(n), kFocal * std::tan(e), kFocal);
  EXPECT_NEAR(approachAngle(n, t), general, 1e-14);
  EXPECT_NEAR(eq1, expected_eq1, 1e-14);
  EXPECT_GT(std::abs(eq1 - general), 0.5 * kDegree);
}

TEST(ApproachAngleVariance, IsThatOfSamples) {
  const Eigen::Vector3d n = downward(0.15, 0.1), t(0.1, 0.02, 0.9);
  Eigen::Matrix3d Ln, Lt;
  Ln << 2e-3, 0, 0, 1e-3, 1e-3, 0, 0, -1e-3, 3e-3;
  Lt << 4e-3, 0, 0, 1e-3, 2e-3, 0, -2e-3, 1e-3, 2e-2;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();
  const Eigen::Matrix3d normal_covariance = across * Ln * Ln.transpose() * across;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  constexpr int kSamples = 20000;
  double variance = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d sample = (n + across * (Ln * draw())).normalized();
    variance += std::pow(approachAngle(sample, t + Lt * draw()) - approachAngle(n, t), 2) / kSamples;
  }
  EXPECT_NEAR(approachAngleVariance(n, normal_covariance, t, Lt * Lt.transpose()) / variance, 1, 0.05);
  // Only the direction of t matters.
  EXPECT_NEAR(approachAngleVariance(n, normal_covariance, 10 * t, 100 * Lt * Lt.transpose()),
              approachAngleVariance(n, normal_covariance, t, Lt * Lt.transpose()), 1e-15);
}

}  // namespace
}  // namespace uav_landing
