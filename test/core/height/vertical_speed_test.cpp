#include "height/vertical_speed.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace uav_landing {
namespace {

// A step of 0.05 s at 10 m: 20 m/s forward, 2 m/s down, the ground level in a level camera.
constexpr double kT = 0.05, kHeight = 10, kForward = 20, kSink = 2;
const Eigen::Vector3d kDown(0, 1, 0);
const Eigen::Vector3d kWay(0, kSink* kT, kForward* kT);  // m

/// What is uncertain, 1 sigma each.
struct Stddevs {
  double height = 0;        // m
  double tilt = 0;          // of the normal in pitch, rad
  double way = 0;           // of each component of the way over the height
  double slope = 0;         // rad
  double acceleration = 0;  // m/s^2
};

VerticalSpeed estimate(const Stddevs& stddevs, double height, const Eigen::Vector3d& normal,
                       const Eigen::Vector3d& way_over_height) {
  ApproachAngleResult::Motion step;
  step.duration = kT;
  step.translation_over_height = way_over_height;
  step.covariance.setZero();
  step.covariance.bottomRightCorner<3, 3>() = stddevs.way * stddevs.way * Eigen::Matrix3d::Identity();
  GroundPlane plane{normal / height, Eigen::Matrix3d::Zero()};
  // A normal that is tilted by a small angle moves along the optical axis.
  plane.covariance(2, 2) = std::pow(stddevs.tilt / height, 2);
  return verticalSpeed(step, plane, height,
                       {stddevs.height * stddevs.height, stddevs.slope, stddevs.acceleration});
}

TEST(VerticalSpeed, IsTheWayAlongTheNormalOverTheTime) {
  EXPECT_NEAR(estimate({}, kHeight, kDown, kWay / kHeight).speed, -kSink, 1e-12);
  EXPECT_NEAR(estimate({}, kHeight, kDown, kWay / kHeight).variance, 0, 1e-12);
}

class VerticalSpeedVariance : public testing::TestWithParam<Stddevs> {};

TEST_P(VerticalSpeedVariance, IsThatOfSamples) {
  const Stddevs& stddevs = GetParam();
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  constexpr int kSamples = 20000;
  double squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double tilt = stddevs.tilt * normal(random);
    const Eigen::Vector3d n = Eigen::Vector3d(0, 1, tilt).normalized();
    const Eigen::Vector3d off(normal(random), normal(random), normal(random));
    const double measured =
        estimate({}, kHeight + stddevs.height * normal(random), n, kWay / kHeight + stddevs.way * off).speed;
    // The surface below is inclined to the plane ahead, and the speed now is that of half a step later.
    const double truth = -kSink - stddevs.slope * normal(random) * std::hypot(kForward, kSink) +
                         stddevs.acceleration * normal(random) * 0.5 * kT;
    squares += std::pow(measured - truth, 2) / kSamples;
  }
  const double claimed = estimate(stddevs, kHeight, kDown, kWay / kHeight).variance;
  EXPECT_NEAR(claimed / squares, 1, 0.05);
}

INSTANTIATE_TEST_SUITE_P(OfEachSourceAloneAndOfAll, VerticalSpeedVariance,
                         testing::Values(Stddevs{0.3, 0, 0, 0, 0}, Stddevs{0, 0.01, 0, 0, 0},
                                         Stddevs{0, 0, 1e-3, 0, 0}, Stddevs{0, 0, 0, 0.02, 0},
                                         Stddevs{0, 0, 0, 0, 4}, Stddevs{0.3, 0.003, 3e-4, 0.003, 2}));

TEST(VerticalSpeed, OfAStepWithoutMotionOrTimeIsNotKnown) {
  ApproachAngleResult::Motion step;
  step.duration = kT;
  step.translation_over_height = kWay / kHeight;
  step.covariance.setZero();
  const GroundPlane plane{kDown / kHeight, Eigen::Matrix3d::Zero()};
  step.failure = {Reason::kNoMotion, ""};
  EXPECT_TRUE(std::isnan(verticalSpeed(step, plane, kHeight, {}).speed));
  step.failure = {};
  step.duration = 0;
  EXPECT_TRUE(std::isnan(verticalSpeed(step, plane, kHeight, {}).variance));
}

}  // namespace
}  // namespace uav_landing
