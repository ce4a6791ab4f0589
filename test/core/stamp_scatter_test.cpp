#include "uav_landing/stamp_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing {
namespace {

constexpr double kStep = 0.05, kSpeed = 20;  // s, m/s

/// Mean of what is said of the durations in a flight whose stamps are wrong by so much and whose ways are by
/// the other. s, m.
double scatterOf(double stamp_stddev, double way_stddev, double claimed_way_stddev) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  StampScatter scatter(3);
  double before = 0, sum = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double late = stamp_stddev * normal(random);
    scatter.follow(kStep + late - before, kSpeed * kStep + way_stddev * normal(random),
                   claimed_way_stddev * claimed_way_stddev);
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
    scatter.follow(kStep, i == 20 ? 5 : speed * kStep, 1e-8);
    EXPECT_EQ(scatter.ofDuration(), 0) << i;
  }
}

TEST(StampScatter, StandingStillTellsNothing) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  StampScatter scatter(3);
  for (int i = 0; i < 100; ++i) scatter.follow(kStep, std::abs(0.01 * normal(random)), 1e-4);
  EXPECT_EQ(scatter.ofDuration(), 0);
}

}  // namespace
}  // namespace uav_landing
