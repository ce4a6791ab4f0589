#include "integrity/tests/solution_separation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

SolutionSeparation::Measurements same(double height, double variance) {
  SolutionSeparation::Measurements all;
  all.fill({height, variance, 0});
  return all;
}

TEST(SolutionSeparation, BoundsTheErrorByTheSolutionWithoutTheSourceThatIsWrong) {
  KalmanHeightParameters parameters;
  parameters.integrity_risk = 1e-5;
  parameters.fault_probability = 1e-3;
  parameters.unwatched_scale_error = 0;
  parameters.use_motion = false;
  SolutionSeparation separation(parameters);
  SolutionSeparation::Measurements without = same(10, 0.01);
  // The left half of the image is wrong by half a metre; only the filter without it knows.
  without[static_cast<int>(FaultySource::kLeft)].height = 9.5;
  separation.start(without, 10);
  const auto level = separation.protectionLevel(10, 0.01);
  EXPECT_STREQ(level.source, "left_region");
  EXPECT_NEAR(level.bound, 0.5 + 2.576 * 0.1, 1e-3);  // 1 % to both sides: 2.576 sigma
  // Pair after pair the noise averages out, the separation stays.
  for (int i = 0; i < 50; ++i) {
    separation.predict(0.05);
    separation.update(without);
  }
  const auto later = separation.protectionLevel(10, 0.001);
  EXPECT_GT(later.bound, 0.5);
  EXPECT_LT(later.bound, level.bound);
}

TEST(SolutionSeparation, IsWiderByTheFactorThatClaimsAreWrongBy) {
  KalmanHeightParameters parameters;
  parameters.unwatched_scale_error = 0;
  SolutionSeparation separation(parameters);
  separation.start(same(10, 0.01), 10);
  // With the default prior of a fault, 1e-3, and risk, 1e-5: 2.576 sigma.
  EXPECT_NEAR(separation.protectionLevel(10, 1e-12).bound, 2.576 * 0.1, 1e-3);
  EXPECT_NEAR(separation.protectionLevel(10, 1e-12, 4).bound, 2.576 * 0.2, 1e-3);
}

TEST(SolutionSeparation, HardlyGrowsByASinglePairThatIsUncertain) {
  KalmanHeightParameters parameters;
  parameters.unwatched_scale_error = 0;
  SolutionSeparation separation(parameters);
  SolutionSeparation::Measurements without = same(10, 0.0002);
  for (auto& one : without) one.common.bend = 0.0001;
  separation.start(without, 10);
  for (int i = 0; i < 20; ++i) {
    separation.predict(0.05);
    separation.update(without);
    separation.updateSpeed(0, 1e-4);
  }
  const double before = separation.protectionLevel(10, 1e-12).bound;
  for (auto& one : without) one = {10, 0.0101, 0.01};
  separation.update(without);
  EXPECT_LT(separation.protectionLevel(10, 1e-12).bound, 1.2 * before);
}

TEST(SolutionSeparation, GrowsWhereNothingIsLeftWithoutTheSource) {
  SolutionSeparation separation({});
  separation.start(same(10, 0.0001), 10);
  SolutionSeparation::Measurements without = same(10, 0.0001);
  without[static_cast<int>(FaultySource::kNear)] = {};
  double before = 0;
  for (int i = 0; i < 20; ++i) {
    separation.predict(0.05);
    separation.update(without);
    const auto level = separation.protectionLevel(10, 0.0001);
    if (i > 5) {
      EXPECT_STREQ(level.source, "near_region");
      EXPECT_GT(level.bound, before);
    }
    before = level.bound;
  }
}

TEST(SolutionSeparation, HasTheScaleThatNothingSeesInIt) {
  KalmanHeightParameters parameters;
  parameters.unwatched_scale_error = 0.02;
  SolutionSeparation separation(parameters);
  EXPECT_NEAR(separation.protectionLevel(10, 1e-12).bound, 0.2, 1e-4);
  EXPECT_STREQ(separation.protectionLevel(10, 1e-12).source, "scale");
  EXPECT_STREQ(separation.protectionLevel(10, 1).source, "noise");
  EXPECT_NEAR(separation.protectionLevel(10, 1).bound, 4.417, 1e-3);
}

}  // namespace
}  // namespace uav_landing
