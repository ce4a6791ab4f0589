#include "time_difference.h"

#include <gtest/gtest.h>

#include <random>

namespace uav_landing {
namespace {

TEST(TimeDifference, IsTheDurationToTheLastBitWhereThereIsOne) {
  std::mt19937 random(1);
  for (int i = 0; i < 10000; ++i) {
    const ros::Time a(1700000000 + random() % 1000, random() % 1000000000);
    const ros::Time b(1700000000 + random() % 1000, random() % 1000000000);
    EXPECT_EQ(secondsBetween(a, b), (b - a).toSec());
  }
}

TEST(TimeDifference, IsANumberForAnyTwoStamps) {
  const ros::Time zero, last = ros::TIME_MAX;
  EXPECT_ANY_THROW(last - zero);
  EXPECT_NEAR(secondsBetween(zero, last), 4294967296.0, 1e-6);
  EXPECT_NEAR(secondsBetween(last, zero), -4294967296.0, 1e-6);
}

}  // namespace
}  // namespace uav_landing
