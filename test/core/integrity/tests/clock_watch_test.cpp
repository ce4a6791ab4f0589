#include "integrity/tests/clock_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing {
namespace {

constexpr double kPeriod = 0.05, kSpeed = 20;  // s, m/s
constexpr double kVariance = 1e-6;             // m^2, of a way

/// A watch after regular steps at kSpeed.
ClockWatch afterRegularSteps(int steps = 5) {
  ClockWatch clock;
  for (int i = 0; i < steps; ++i) EXPECT_FALSE(clock.follow({kPeriod, kSpeed * kPeriod, kVariance})) << i;
  return clock;
}

class ClockSteps : public testing::TestWithParam<double> {};

TEST_P(ClockSteps, AreNoticedByTheWayOfOnePeriod) {
  ClockWatch clock = afterRegularSteps();
  const std::optional<double> time = clock.follow({kPeriod + GetParam(), kSpeed * kPeriod, kVariance});
  ASSERT_TRUE(time);
  EXPECT_NEAR(*time, kPeriod, 1e-9);
  // The next one as well, although only one step was regular since.
  EXPECT_FALSE(clock.follow({kPeriod, kSpeed * kPeriod, kVariance}));
  EXPECT_TRUE(clock.follow({kPeriod + GetParam(), kSpeed * kPeriod, kVariance}));
}

INSTANTIATE_TEST_SUITE_P(AheadAndBack, ClockSteps, testing::Values(-0.047, 0.047, 0.1, 0.3, 0.9));

TEST(ClockWatch, StampsThatWereLeftOutAsLateAreInTheWay) {
  // The clock was set back by three periods: two stamps were late, the third repeated, and the next one is a
  // period after the last one that was used. The camera has flown for four.
  ClockWatch clock = afterRegularSteps();
  const std::optional<double> time = clock.follow({kPeriod, 4 * kSpeed * kPeriod, kVariance});
  ASSERT_TRUE(time);
  EXPECT_NEAR(*time, 4 * kPeriod, 1e-9);
}

TEST(ClockWatch, ADroppedFrameIsInTheStampsAndInTheWay) {
  ClockWatch clock = afterRegularSteps();
  for (const int frames : {2, 1, 5, 1, 1, 12, 1})
    EXPECT_FALSE(clock.follow({frames * kPeriod, frames * kSpeed * kPeriod, kVariance})) << frames;
}

TEST(ClockWatch, APictureThatStandsStillAndTheOneAfterItAreNoClock) {
  ClockWatch clock = afterRegularSteps();
  EXPECT_FALSE(clock.follow({kPeriod, 0.001, kVariance}));
  EXPECT_FALSE(clock.follow({kPeriod, 2 * kSpeed * kPeriod, kVariance}));
  EXPECT_FALSE(clock.follow({kPeriod, kSpeed * kPeriod, kVariance}));
}

TEST(ClockWatch, BrakesAndGustsAreNoClock) {
  ClockWatch clock = afterRegularSteps();
  double speed = kSpeed;
  for (int i = 0; speed > 1; ++i, speed -= 6 * kPeriod)
    EXPECT_FALSE(clock.follow({kPeriod, speed * kPeriod, kVariance})) << i;
  for (int i = 0; i < 50; ++i)
    EXPECT_FALSE(clock.follow({kPeriod, (kSpeed + (i % 2 ? 1 : -1)) * kPeriod, kVariance})) << i;
}

TEST(ClockWatch, StampsThatJitterAreNoClock) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> late(0, 0.04);
  ClockWatch clock;
  double before = 0;
  int noticed = 0;
  for (int i = 0; i < 1000; ++i) {
    const double now = late(random);
    noticed += clock.follow({kPeriod + now - before, kSpeed * kPeriod, kVariance}).has_value();
    before = now;
  }
  EXPECT_EQ(noticed, 0) << "late by up to 40 ms";
}

TEST(ClockWatch, AClockThatRunsFastOrSlowByAFewPerCentIsNotSet) {
  ClockWatch clock = afterRegularSteps();
  for (int i = 0; i < 50; ++i)
    EXPECT_FALSE(clock.follow({(i < 25 ? 1.05 : 0.95) * kPeriod, kSpeed * kPeriod, kVariance})) << i;
}

TEST(ClockWatch, AWayThatIsHardlyKnownTellsNoTime) {
  ClockWatch clock = afterRegularSteps();
  const double stddev = 0.1 * kSpeed * kPeriod;
  EXPECT_FALSE(clock.follow({0.5, kSpeed * kPeriod, stddev * stddev}));
}

TEST(ClockWatch, SaysNothingBeforeEnoughStepsWereRegularAndAfterAGap) {
  ClockWatch clock = afterRegularSteps(4);
  EXPECT_FALSE(clock.follow({0.5, kSpeed * kPeriod, kVariance}));
  clock = afterRegularSteps();
  clock.skip();
  EXPECT_FALSE(clock.follow({kPeriod, kSpeed * kPeriod, kVariance}));
  EXPECT_FALSE(clock.follow({0.5, kSpeed * kPeriod, kVariance}));
}

}  // namespace
}  // namespace uav_landing
