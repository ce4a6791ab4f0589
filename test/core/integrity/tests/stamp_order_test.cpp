#include "integrity/tests/stamp_order.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

using Arrival = StampOrder::Arrival;
constexpr int64_t kMs = 1000000;

TEST(StampOrder, LeavesOutWhatIsLateByUpToTheLimitAndGoesOn) {
  StampOrder order(0.3);
  EXPECT_EQ(order.follow(10000 * kMs), Arrival::kNext);
  EXPECT_EQ(order.follow(10050 * kMs), Arrival::kNext);
  EXPECT_EQ(order.follow(10050 * kMs), Arrival::kRepeated);
  EXPECT_EQ(order.follow(10020 * kMs), Arrival::kLate);
  EXPECT_EQ(order.follow(9750 * kMs), Arrival::kLate);
  EXPECT_EQ(order.follow(10051 * kMs), Arrival::kNext);
}

TEST(StampOrder, AStepBackByMoreIsThatOfAClock) {
  StampOrder order(0.3);
  order.follow(10000 * kMs);
  EXPECT_EQ(order.follow(9699 * kMs), Arrival::kBackwards);
  EXPECT_EQ(order.follow(9750 * kMs), Arrival::kNext) << "the new time counts";
  EXPECT_EQ(order.follow(9700 * kMs), Arrival::kLate);
}

TEST(StampOrder, NoStampIsNoTime) {
  StampOrder order(0.3);
  EXPECT_EQ(order.follow(0), Arrival::kUnstamped);
  EXPECT_EQ(order.follow(10000 * kMs), Arrival::kNext);
  EXPECT_EQ(order.follow(0), Arrival::kUnstamped) << "and no clock set back";
  EXPECT_EQ(order.follow(9999 * kMs), Arrival::kLate);
  EXPECT_FALSE(StampOrder::isUsed(Arrival::kUnstamped));
}

TEST(StampOrder, WithoutALimitEveryStepBackIsThatOfAClock) {
  StampOrder order(0);
  order.follow(10000 * kMs);
  EXPECT_EQ(order.follow(10000 * kMs - 1), Arrival::kBackwards);
}

TEST(StampOrder, LateOnesAloneAreThoseOfAClockThatWasSetBack) {
  StampOrder order(0.3);
  order.follow(10000 * kMs);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(order.follow((9880 - 20 * (i % 5)) * kMs), Arrival::kLate) << i;
  EXPECT_EQ(order.follow(9880 * kMs), Arrival::kBackwards);
  EXPECT_EQ(order.follow(9900 * kMs), Arrival::kNext);
}

TEST(StampOrder, ThreeLateOnesInOrderAreThoseOfAClockThatWasSetBack) {
  StampOrder order(0.3);
  order.follow(10000 * kMs);
  EXPECT_EQ(order.follow(9850 * kMs), Arrival::kLate);
  EXPECT_EQ(order.follow(9900 * kMs), Arrival::kLate);
  EXPECT_EQ(order.follow(9950 * kMs), Arrival::kBackwards);
  EXPECT_EQ(order.follow(10000 * kMs), Arrival::kNext);
  EXPECT_EQ(order.follow(9990 * kMs), Arrival::kLate) << "the count has begun anew";
  EXPECT_EQ(order.follow(9970 * kMs), Arrival::kLate);
  EXPECT_EQ(order.follow(9980 * kMs), Arrival::kLate) << "two of three are in order";
}

TEST(StampOrder, LateOnesBetweenOthersAreNoClock) {
  StampOrder order(0.3);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(order.follow((10000 + 50 * i) * kMs), Arrival::kNext);
    EXPECT_EQ(order.follow((9975 + 50 * i) * kMs), Arrival::kLate);
  }
}

TEST(StampOrder, AfterAResetAnyStampIsTheFirst) {
  StampOrder order(0.3);
  order.follow(10000 * kMs);
  order.reset();
  EXPECT_EQ(order.follow(9900 * kMs), Arrival::kNext);
  order.reset();
  EXPECT_EQ(order.follow(1), Arrival::kNext) << "the first nanosecond of a simulated clock";
  // Nor are the late ones before it counted.
  order.follow(10000 * kMs);
  for (const int ms : {9850, 9900}) EXPECT_EQ(order.follow(ms * kMs), Arrival::kLate);
  order.reset();
  order.follow(10000 * kMs);
  EXPECT_EQ(order.follow(9950 * kMs), Arrival::kLate);
}

}  // namespace
}  // namespace uav_landing
