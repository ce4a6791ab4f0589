#include "integrity/tests/stamp_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

constexpr double kStep = 0.05, kSpeed = 20;  // s, m/s

/// Mean of what is said of the durations in a flight whose stamps are wrong by so much and whose ways are by
/// the other. s, m.
double scatterOf(double stamp_stddev, double way_stddev, double claimed_way_stddev, double speed = kSpeed) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  StampScatter scatter(3);
  double before = 0, sum = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double late = stamp_stddev * normal(random);
    scatter.follow({kStep + late - before, speed * kStep + way_stddev * normal(random),
                    claimed_way_stddev * claimed_way_stddev});
    before = late;
    sum += scatter.ofDuration() / kSteps;
  }
  return sum;
}

TEST(StampScatter, IsThatOfTheDurations) {
  // Each duration has two stamps in it.
  const double expected = 2 * std::pow(0.003 / kStep, 2);
  EXPECT_NEAR(scatterOf(0.003, 0, 1e-4) / expected, 1, 0.4);
}

TEST(StampScatter, OfTheDurationsIsWhatTheWaysDoNotExplain) {
  // Ways of 3 m that are known to 5 %.
  const double expected = 2 * std::pow(0.003 / kStep, 2);
  EXPECT_NEAR(scatterOf(0.003, 0.15, 0.15, 60) / expected, 1, 0.4);
}

/// A flight whose stamps are wrong by 10 ms in turn.
StampScatter scattered() {
  StampScatter scatter(3);
  for (int i = 0; i < 20; ++i) scatter.follow({kStep + (i % 2 == 0 ? 0.01 : -0.01), kSpeed * kStep, 1e-8});
  EXPECT_GT(scatter.ofDuration(), 0.01);
  return scatter;
}

TEST(StampScatter, GoodStampsEndIt) {
  StampScatter scatter = scattered();
  for (int i = 0; i < 20; ++i) scatter.follow({kStep, kSpeed * kStep, 1e-8});
  EXPECT_EQ(scatter.ofDuration(), 0);
}

TEST(StampScatter, ASpeedThatChangesInAGapIsNoWrongStamp) {
  StampScatter scatter(3);
  for (int i = 0; i < 40; ++i) {
    scatter.follow({kStep, (i % 2 == 0 ? 1 : 1.5) * kSpeed * kStep, 1e-8});
    scatter.skip();
  }
  EXPECT_EQ(scatter.ofDuration(), 0);
}

TEST(StampScatter, OfGoodStampsIsNextToNothing) {
  EXPECT_EQ(scatterOf(0, 0, 1e-4), 0);
  // Ways that scatter by what they claim do not make stamps wrong; the median of few is not exact.
  EXPECT_LT(scatterOf(0, 0.05, 0.05), 0.1 * std::pow(0.05 / (kSpeed * kStep), 2));
}

TEST(StampScatter, ASingleWrongMotionAndAGustAreNoWrongStamps) {
  StampScatter scatter(3);
  double speed = kSpeed;
  for (int i = 0; i < 40; ++i) {
    speed += (i % 10 < 5 ? 1 : -1) * 2.5 * kStep;
    scatter.follow({kStep, i == 20 ? 5 : speed * kStep, 1e-8});
    EXPECT_EQ(scatter.ofDuration(), 0) << i;
  }
}

TEST(StampScatter, StandingStillTellsNothing) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  StampScatter scatter(3);
  for (int i = 0; i < 100; ++i) scatter.follow({kStep, std::abs(0.01 * normal(random)), 1e-4});
  EXPECT_EQ(scatter.ofDuration(), 0);
}

/// How many of the heights, which are all true, are refused in 10 s of a flight of 20 m/s that sinks by 2 m/s
/// and whose stamps are late by up to 0.04 s at random.
int refusedWithLateStamps(const KalmanHeightParameters& parameters) {
  constexpr double kPitch = -4 * M_PI / 180, kSink = 2;
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  KalmanHeightStage stage(test::rigOf({640, 480}, 500, {320, 240}, 320, 1.0), parameters);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> late(0, 0.04);
  double before = 0;
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    StereoDepthResult stereo;
    const double height = 30 - kSink * kStep * i;
    stereo.stamp = 1 + kStep * i + (i < 40 ? 0 : late(random));
    stereo.plane.g = down / height;
    const double relative = 0.01 / height;
    stereo.plane.covariance = std::pow(relative / height, 2) * Eigen::Matrix3d::Identity();
    ApproachAngleResult approach;
    approach.stamp = stereo.stamp;
    approach.n = down;
    approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
    approach.step.duration = i > 0 ? stereo.stamp - before : kStep;
    approach.step.rotation.setZero();
    approach.step.translation_over_height = kStep * (kSpeed * forward + kSink * down) / height;
    approach.step.covariance = 1e-8 * Matrix6d::Identity();
    approach.step.angle = std::atan(kSink / kSpeed);
    approach.step.angle_variance = 1e-6;
    refused += stage.process(stereo, approach).rejected;
    before = stereo.stamp;
  }
  return refused;
}

TEST(KalmanHeightStamps, TrueHeightsAreNotRefusedForStampsThatAreLate) {
  EXPECT_EQ(refusedWithLateStamps({}), 0);
  // Of the stamps alone, not of the vertical speeds that scatter with them.
  KalmanHeightParameters parameters;
  parameters.integrity_monitor = false;
  EXPECT_EQ(refusedWithLateStamps(parameters), 0);
  // An aircraft that may change its speed at will says nothing of the stamps.
  parameters.max_deceleration = 1000;
  EXPECT_GT(refusedWithLateStamps(parameters), 10);
}

}  // namespace
}  // namespace uav_landing
