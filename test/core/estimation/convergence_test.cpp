#include "estimation/convergence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

/// What is left, in standard deviations, when iterations end of which each leaves a share of what was left,
/// after a first step that leaves `after_first`.
double leftOver(double start, double share, double after_first) {
  Convergence convergence;
  if (convergence.reached(start - after_first)) return after_first;
  double left = after_first;
  for (int i = 0; i < 1000; ++i) {
    const double before = left;
    left *= share;
    if (convergence.reached(before - left)) return std::abs(left);
  }
  return INFINITY;
}

TEST(Convergence, LeavesLittleWhateverTheShare) {
  for (const double start : {0.01, 0.1, 0.4, 1.0, 100.0})
    for (const double share : {0.001, 0.1, 0.3, 0.5}) {
      EXPECT_LT(leftOver(start, share, share * start), 0.051) << start << " " << share;
    }
  for (const double start : {1.0, 100.0}) EXPECT_LT(leftOver(start, 0.9, 0.9 * start), 0.051) << start;
}

TEST(Convergence, LeavesLittleAfterAFirstStepThatTookMostAway) {
  for (const double start : {10.0, 100.0})
    for (const double after : {0.2, 0.3, 1.0})
      for (const double share : {0.1, 0.2, 0.25, 0.3})
        EXPECT_LT(leftOver(start, share, after), 0.07) << start << " " << after << " " << share;
}

TEST(Convergence, EndsAsSoonAsThat) {
  // Steps of 5, 0.83, 0.14: what is left is then 0.028.
  Convergence convergence;
  EXPECT_FALSE(convergence.reached(5));
  EXPECT_FALSE(convergence.reached(5.0 / 6));
  EXPECT_TRUE(convergence.reached(5.0 / 36));
}

TEST(Convergence, IsAtOnceWhereNothingMoves) {
  EXPECT_TRUE(Convergence().reached(0));
  EXPECT_TRUE(Convergence().reached(0.04));
  EXPECT_FALSE(Convergence().reached(0.06));
}

TEST(Convergence, IsNotWhileStepsGrow) {
  Convergence convergence;
  for (const double step : {0.06, 0.06, 0.1, 10.0}) EXPECT_FALSE(convergence.reached(step)) << step;
}

TEST(Convergence, IsNotOfStepsThatAreNoNumber) { EXPECT_FALSE(Convergence().reached(NAN)); }

}  // namespace
}  // namespace uav_landing
