#include "base/steadiness.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

/// Steady, as a search has found it to be.
Steadiness steady(double share = 0.8) {
  Steadiness steadiness(1, 2);
  steadiness.searched();
  steadiness.note(share, 0.5);
  return steadiness;
}

TEST(Steadiness, NeedsASearchFirst) { EXPECT_FALSE(Steadiness(1, 2).goesWithout()); }

TEST(Steadiness, GoesWithoutWhereMostAgreeAndAllIsAsExpected) {
  EXPECT_TRUE(steady().goesWithout());
  EXPECT_TRUE(steady(0.5).goesWithout());
  EXPECT_FALSE(steady(0.49).goesWithout());
  Steadiness off = steady();
  off.note(0.8, 1.01);
  EXPECT_FALSE(off.goesWithout());
  off.note(0.8, 0.99);
  EXPECT_TRUE(off.goesWithout());
  off.lose();
  EXPECT_FALSE(off.goesWithout());
}

TEST(Steadiness, SearchesEachTenthTime) {
  Steadiness steadiness = steady();
  int without = 0;
  for (int i = 0; i < 50; ++i) {
    if (steadiness.goesWithout()) {
      ++without;
    } else {
      steadiness.searched();
    }
    steadiness.note(0.8, 0.5);
  }
  EXPECT_EQ(without, 45);
}

TEST(Steadiness, IsBorneOutByNearlyAsManyThatAreNear) {
  const Steadiness steadiness = steady(0.8);
  EXPECT_TRUE(steadiness.bearsOut(0.73, 1.9));
  EXPECT_FALSE(steadiness.bearsOut(0.71, 1.9));
  EXPECT_FALSE(steadiness.bearsOut(0.8, 2.1));
}

TEST(Steadiness, ComparesWithWhatTheLastSearchFound) {
  Steadiness steadiness = steady(0.8);
  for (const double share : {0.76, 0.74}) {
    ASSERT_TRUE(steadiness.goesWithout());
    ASSERT_TRUE(steadiness.bearsOut(share, 0.5));
    steadiness.note(share, 0.5);
  }
  EXPECT_FALSE(steadiness.bearsOut(0.7, 0.5)) << "little by little more than a tenth was lost";
  steadiness.searched();
  steadiness.note(0.7, 0.5);
  EXPECT_TRUE(steadiness.bearsOut(0.65, 0.5));
}

}  // namespace
}  // namespace uav_landing
