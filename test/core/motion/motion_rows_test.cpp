#include "motion/step/motion_rows.h"

#include <gtest/gtest.h>

#include "support/motion_matches.h"

namespace uav_landing {
namespace {

using test::Matcher;
using test::motionRig;
using test::Step;

MotionState stateOf(const Step& step, const Eigen::Vector3d& t) {
  return {step.movement.R.transpose(), t, step.n};
}

TEST(MotionRows, MatchesAlongALineFitAnyMotionButDoNotTellIt) {
  constexpr int kLines = 25, kPoints = 8;
  const Step step = Step::make();
  std::vector<TemporalMatch> matches = Matcher(step, 1).ground(kLines + kPoints, 0);
  for (int i = 0; i < kLines; ++i) matches[i].covariance(1, 1) = 400;  // px^2, along columns
  MotionRows rows;
  rows.assign(motionRig(), matches);
  const MotionSupport right = rows.support(stateOf(step, step.t));
  EXPECT_EQ(right.close, kLines + kPoints);
  EXPECT_EQ(right.telling, kPoints);
  EXPECT_EQ(right.telling_close, kPoints);
  EXPECT_NEAR(right.votes, kLines + kPoints, 1e-6);
  // Sunk as much again, all ground moves by pixels along the columns.
  const MotionSupport wrong = rows.support(stateOf(step, step.t + 0.02 * step.n));
  EXPECT_GT(wrong.close, kLines / 2);
  EXPECT_EQ(wrong.telling, kPoints);
  EXPECT_LT(wrong.telling_close, 0.5 * kPoints);
}

}  // namespace
}  // namespace uav_landing
