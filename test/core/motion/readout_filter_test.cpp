#include "motion/step/readout_filter.h"

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
  // One of five cameras has 0, the others 0 +- 20 ms.
  EXPECT_NEAR(stddevOf(filter), 0.02 * std::sqrt(0.8), 1e-3);
}

TEST(ReadoutFilter, BeginsWithAnyTimeWhereRowsWereSeenToRoll) {
  ReadoutFilter filter(ReadoutFilter::kGlobalAfterSign);
  EXPECT_EQ(filter.estimate().time, 0);
  EXPECT_NEAR(stddevOf(filter), 0.02, 1e-3);
  EXPECT_NEAR(filter.globalProbability(), ReadoutFilter::kGlobalAfterSign, 1e-9);
  // Where it was ground that is no plane, a global shutter comes back.
  for (int i = 0; i < 1200; ++i) filter.learn(effectOf(1e4, -filter.estimate().time), 0.05);
  EXPECT_GT(filter.globalProbability(), 5 * ReadoutFilter::kGlobalAfterSign);
  EXPECT_LT(stddevOf(filter), 0.003);
}

TEST(ReadoutFilter, FindsTheTimeAndKnowsItBetterAndBetter) {
  constexpr double kTime = 0.03, kStep = 0.05, kOfStep = 0.01;  // s
  ReadoutFilter filter;
  for (int i = 0; i < 600; ++i) {
    filter.learn(effectOf(1 / (kOfStep * kOfStep), kTime - filter.estimate().time), kStep);
    EXPECT_LT(std::abs(filter.estimate().time - kTime), 3 * stddevOf(filter)) << i;
  }
  // 30 s of which 4 s count as one, and the prior.
  const double information = 30 / 4.0 / (kOfStep * kOfStep), all = information + 1 / (0.02 * 0.02);
  EXPECT_NEAR(filter.estimate().time, kTime * information / all, 1e-4);
  EXPECT_GE(stddevOf(filter), 1 / std::sqrt(all));
  EXPECT_LT(stddevOf(filter), 0.005);
}

TEST(ReadoutFilter, CorrectsNothingOfAGlobalShutterAndClaimsHardlyMoreInTheEnd) {
  // Steps with errors of 1 sigma, all alike, as they may be over some seconds.
  constexpr double kStep = 0.05, kOfStep = 0.01;  // s
  for (const double error : {0.0, kOfStep, -kOfStep}) {
    ReadoutFilter filter;
    for (int i = 0; i < 80; ++i) {
      filter.learn(effectOf(1 / (kOfStep * kOfStep), error - filter.estimate().time), kStep);
      EXPECT_EQ(filter.estimate().time, 0);
    }
    EXPECT_LT(stddevOf(filter), 0.0125);
    for (int i = 0; i < 1200; ++i)
      filter.learn(effectOf(1 / (kOfStep * kOfStep), -filter.estimate().time), kStep);
    EXPECT_EQ(filter.estimate().time, 0);
    EXPECT_LT(stddevOf(filter), 0.002);
    EXPECT_GT(filter.globalProbability(), 0.5);
  }
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
