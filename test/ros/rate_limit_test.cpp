#include "rate_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace uav_landing;

namespace {

/// Of a camera's stamps (Hz, 1 sigma of their jitter in s) in ten seconds, how many a second pass.
double passing(double camera, double jitter, double rate) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  RateLimit limit;
  constexpr double kSeconds = 10;
  int passed = 0;
  for (int i = 0; i < kSeconds * camera; ++i) {
    const ros::Time stamp(1000 + i / camera + jitter * normal(random));
    passed += limit.passes(stamp, rate) ? 1 : 0;
  }
  return passed / kSeconds;
}

TEST(RateLimit, LeavesASlowerCameraAlone) {
  EXPECT_EQ(passing(20, 0, 50), 20);
  EXPECT_EQ(passing(50, 0, 50), 50) << "just as fast";
  EXPECT_NEAR(passing(50, 0.001, 50), 50, 0.5) << "just as fast with stamps that jitter";
}

TEST(RateLimit, LetsNoMoreThanTheRatePassAndHardlyLess) {
  EXPECT_NEAR(passing(60, 0, 30), 30, 0.2);
  for (const double camera : {55.0, 60.0, 90.0, 200.0})
    for (const double jitter : {0.0, 0.001}) {
      EXPECT_GT(passing(camera, jitter, 50), 47.5) << camera;
      EXPECT_LT(passing(camera, jitter, 50), 50.2) << camera;
    }
}

TEST(RateLimit, NoTwoComeMuchCloserThanThePeriod) {
  RateLimit limit;
  ros::Time last;
  for (int i = 0; i < 1000; ++i) {
    const ros::Time stamp(1000 + i / 55.0);
    if (!limit.passes(stamp, 50)) continue;
    if (!last.isZero()) {
      EXPECT_GT((stamp - last).toSec(), 0.0149);
    }
    last = stamp;
  }
}

TEST(RateLimit, BeginsAnewAfterAPauseOrAClockThatWasSetBack) {
  RateLimit limit;
  EXPECT_TRUE(limit.passes(ros::Time(1000), 10));
  EXPECT_FALSE(limit.passes(ros::Time(1000.05), 10));
  EXPECT_TRUE(limit.passes(ros::Time(1060), 10));
  EXPECT_FALSE(limit.passes(ros::Time(1060.02), 10)) << "a pause saves nothing up";
  EXPECT_TRUE(limit.passes(ros::Time(5), 10));
  EXPECT_FALSE(limit.passes(ros::Time(5.05), 10));
  EXPECT_TRUE(limit.passes(ros::TIME_MAX, 10)) << "as far away as can be";
}

}  // namespace
