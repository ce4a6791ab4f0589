#include "motion/readout_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace uav_landing {
namespace {

/// A step whose matches, without noise, have so much to say of a readout time.
ReadoutEffect effectOf(double information, double missing) {
  ReadoutEffect effect;
  effect.information = information;
  effect.score = information * missing;
  return effect;
}

double stddevOf(const ReadoutFilter& filter) { return std::sqrt(filter.estimate().variance); }

TEST(ReadoutFilter, BeginsWithWhatAnyCameraMayHave) {
  const ReadoutFilter filter;
  EXPECT_EQ(filter.estimate().time, 0);
  EXPECT_NEAR(stddevOf(filter), 0.02, 1e-3);
}

TEST(ReadoutFilter, FindsTheTimeAndKnowsItBetterAndBetter) {
  constexpr double kTime = 0.03, kStep = 0.05, kOfStep = 0.01;  // s
  ReadoutFilter filter;
  double before = stddevOf(filter);
  for (int i = 0; i < 600; ++i) {
    filter.learn(effectOf(1 / (kOfStep * kOfStep), kTime - filter.estimate().time), kStep);
    EXPECT_LE(stddevOf(filter), before);
    before = stddevOf(filter);
  }
  // 30 s of which 4 s count as one, and the prior.
  const double information = 30 / 4.0 / (kOfStep * kOfStep), all = information + 1 / (0.02 * 0.02);
  EXPECT_NEAR(filter.estimate().time, kTime * information / all, 1e-4);
  EXPECT_GE(before, 1 / std::sqrt(all));
  EXPECT_LT(before, 0.005);
}

TEST(ReadoutFilter, LearnsNothingFromACameraThatHardlyMoves) {
  ReadoutFilter filter;
  const double before = stddevOf(filter);
  for (int i = 0; i < 600; ++i) filter.learn(effectOf(1e-3, 5), 0.05);
  filter.learn(effectOf(0, 0), 0.05);
  filter.learn(effectOf(std::numeric_limits<double>::quiet_NaN(), 1), 0.05);
  EXPECT_NEAR(stddevOf(filter), before, 1e-6);
  EXPECT_NEAR(filter.estimate().time, 0, 1e-3);
}

TEST(ReadoutFilter, IsNotLedAwayByOneStep) {
  ReadoutFilter filter;
  for (int i = 0; i < 200; ++i) filter.learn(effectOf(1e4, -filter.estimate().time), 0.05);
  filter.learn(effectOf(1e6, 1.0), 0.05);
  EXPECT_LT(std::abs(filter.estimate().time), 2 * stddevOf(filter));
}

TEST(ReadoutAdvice, IsGivenWhenItIsUsefulAndCertain) {
  EXPECT_EQ(adviceOn({0.0294, 0.0036 * 0.0036}),
            "rows are read within 29 +- 4 ms, one after the other: set rig/readout_time");
  EXPECT_EQ(adviceOn({0.0294, 0.0060 * 0.0060}), "") << "not known well enough";
  EXPECT_EQ(adviceOn({0.0080, 0.0036 * 0.0036}), "") << "may be a global shutter";
  EXPECT_NE(adviceOn({-0.02, 0.003 * 0.003}), "") << "read from below";
  EXPECT_EQ(adviceOn({}), "") << "given";
}

}  // namespace
}  // namespace uav_landing
