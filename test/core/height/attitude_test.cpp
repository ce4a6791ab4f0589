#include "height/attitude.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "geometry/rotation.h"
#include "support/degree.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

using test::kDegree;

/// An aircraft with its nose down and its right side down that points to the left of a runway that slopes.
constexpr double kPitch = -5 * kDegree, kRoll = 8 * kDegree, kYaw = 6 * kDegree, kSlope = 1 * kDegree;
const Eigen::Vector3d kNormal = normalFromPitchRoll(kPitch, kRoll);

/// The runway's direction: forward on the ground, turned to the right by the yaw, and up by the slope.
Eigen::Vector3d runway() {
  const Eigen::Vector3d forward = (Eigen::Vector3d::UnitZ() - kNormal.z() * kNormal).normalized();
  const Eigen::Vector3d level = Eigen::AngleAxisd(kYaw, kNormal) * forward;
  return std::cos(kSlope) * level - std::sin(kSlope) * kNormal;
}

/// 1 sigma of the normal and of the direction in both directions across them, rad.
struct Stddevs {
  Eigen::Vector2d normal, direction;
};

Eigen::Matrix3d covarianceOf(const Eigen::Vector3d& unit, const Eigen::Vector2d& stddevs) {
  const Eigen::Matrix<double, 3, 2> across = tangents(unit);
  return across * stddevs.cwiseAbs2().asDiagonal() * across.transpose();
}

LandingResult report(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction,
                     const Stddevs& stddevs) {
  LandingResult result;
  reportAttitude(GroundNormal(normal, covarianceOf(normal, stddevs.normal)),
                 GroundDirection(direction, covarianceOf(direction, stddevs.direction)), result);
  return result;
}

TEST(ReportAttitude, IsTheAttitudeThatTheAircraftHas) {
  const LandingResult result = report(kNormal, runway(), {{0, 0}, {0, 0}});
  EXPECT_NEAR(result.pitch, kPitch, 1e-12);
  EXPECT_NEAR(result.roll, kRoll, 1e-12);
  EXPECT_NEAR(result.yaw, kYaw, 1e-12);
  EXPECT_NEAR(result.yaw_variance, 0, 1e-15);
}

class AttitudeVariance : public testing::TestWithParam<Stddevs> {};

TEST_P(AttitudeVariance, IsThatOfSamples) {
  const Stddevs& stddevs = GetParam();
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto drawn = [&](const Eigen::Vector3d& unit, const Eigen::Vector2d& sigma) -> Eigen::Vector3d {
    const Eigen::Vector2d off(sigma.x() * normal(random), sigma.y() * normal(random));
    return (unit + tangents(unit) * off).normalized();
  };
  constexpr int kSamples = 20000;
  double pitch = 0, roll = 0, yaw = 0;
  for (int i = 0; i < kSamples; ++i) {
    const LandingResult sample =
        report(drawn(kNormal, stddevs.normal), drawn(runway(), stddevs.direction), {{0, 0}, {0, 0}});
    pitch += std::pow(sample.pitch - kPitch, 2) / kSamples;
    roll += std::pow(sample.roll - kRoll, 2) / kSamples;
    yaw += std::pow(sample.yaw - kYaw, 2) / kSamples;
  }
  const LandingResult claimed = report(kNormal, runway(), stddevs);
  const auto expectSame = [](double variance, double of_samples) {
    EXPECT_NEAR(variance, of_samples, 0.05 * of_samples + 1e-12);
  };
  expectSame(claimed.pitch_variance, pitch);
  expectSame(claimed.roll_variance, roll);
  expectSame(claimed.yaw_variance, yaw);
}

INSTANTIATE_TEST_SUITE_P(OfEachSourceAloneAndOfAll, AttitudeVariance,
                         testing::Values(Stddevs{{0.003, 0}, {0, 0}}, Stddevs{{0, 0.003}, {0, 0}},
                                         Stddevs{{0, 0}, {0.003, 0}}, Stddevs{{0, 0}, {0, 0.003}},
                                         Stddevs{{0.002, 0.004}, {0.001, 0.003}}));

TEST(ReportAttitude, WithoutARunwayThereIsNoYawAndWithoutANormalNothing) {
  LandingResult without_runway;
  reportAttitude(GroundNormal(kNormal, covarianceOf(kNormal, {1e-3, 1e-3})), std::nullopt, without_runway);
  EXPECT_NEAR(without_runway.pitch, kPitch, 1e-12);
  EXPECT_TRUE(std::isfinite(without_runway.roll_variance));
  EXPECT_TRUE(std::isnan(without_runway.yaw));
  EXPECT_TRUE(std::isnan(without_runway.yaw_variance));
  LandingResult nothing;
  reportAttitude(std::nullopt, GroundDirection(runway(), Eigen::Matrix3d::Zero()), nothing);
  EXPECT_TRUE(std::isnan(nothing.pitch));
  EXPECT_TRUE(std::isnan(nothing.yaw));
}

}  // namespace
}  // namespace uav_landing
