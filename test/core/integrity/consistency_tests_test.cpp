#include "uav_landing/integrity/consistency_tests.h"

#include <gtest/gtest.h>

#include <cmath>

#include "uav_landing/integrity/solution_separation.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {
namespace {

TEST(ConsistencyTests, LimitsAreThoseOfTheChiSquareTable) {
  EXPECT_NEAR(chiSquareLimit(0.05, 1), 3.841, 1e-3);
  EXPECT_NEAR(chiSquareLimit(0.001, 2), 13.816, 1e-3);
  EXPECT_NEAR(normalQuantile(0.05), 1.960, 1e-3);
  EXPECT_NEAR(normalQuantile(1e-5), 4.417, 1e-3);
}

TEST(ConsistencyTests, CountsFailuresInARowAndForgetsThemAtTheNextPairThatPasses) {
  ConsistencyTests tests(0.05);
  for (const double difference : {3.0, 3.0, 1.0}) {
    tests.begin();
    tests.add(Consistency::kRunwayWidth, difference, 1.0);
    const std::vector<TestResult> results = tests.finish();
    const TestResult& width = results[static_cast<int>(Consistency::kRunwayWidth)];
    EXPECT_EQ(width.name, "runway_width");
    EXPECT_EQ(width.failed(), difference > 1.96);
    EXPECT_FALSE(results[static_cast<int>(Consistency::kTilt)].possible());
    if (difference < 2) {
      EXPECT_EQ(width.consecutive_failures, 0);
      EXPECT_EQ(failedTests(results), "");
    } else {
      EXPECT_EQ(failedTests(results), "runway_width");
    }
  }
}

const TestResult& resultOf(const ConsistencyTests& tests) { return tests.result(Consistency::kVelocity); }

TEST(ConsistencyTests, SeveralNumbersAreTestedByTheirCovariance) {
  ConsistencyTests tests(0.05);
  tests.begin();
  Eigen::Matrix2d covariance;
  covariance << 4, 2, 2, 3;
  tests.add(Consistency::kVelocity, Eigen::Vector2d(3, 4), covariance);
  // The inverse is (3, -2; -2, 4) / 8, so that the ratio is (3 * 9 - 4 * 12 + 4 * 16) / 8.
  EXPECT_NEAR(resultOf(tests).ratio, 43.0 / 8, 1e-12);
  EXPECT_NEAR(resultOf(tests).difference, 5, 1e-12);
  EXPECT_NEAR(resultOf(tests).variance, 3.5, 1e-12) << "the mean of both";
  EXPECT_NEAR(resultOf(tests).limit, 5.991, 1e-3);
  EXPECT_FALSE(tests.failed(Consistency::kVelocity));
  tests.add(Consistency::kVelocity, Eigen::Vector2d(4, -4), covariance);
  EXPECT_TRUE(tests.failed(Consistency::kVelocity)) << "against the correlation";
}

TEST(ConsistencyTests, WhatIsWrongInOneDirectionOnlyPassesInTheOther) {
  ConsistencyTests tests(0.05);
  for (const double sign : {-1.0, 1.0}) {
    tests.begin();
    tests.addOneSided(Consistency::kVelocity, sign * 6, 4);
    EXPECT_EQ(resultOf(tests).difference, sign * 6);
    EXPECT_EQ(resultOf(tests).ratio, sign < 0 ? 0 : 9);
    EXPECT_EQ(tests.failed(Consistency::kVelocity), sign > 0);
  }
}

TEST(ConsistencyTests, TheLargestOfManyMayBeLargerForTheSameRateOfFalseAlarms) {
  ConsistencyTests tests(0.05);
  tests.begin();
  tests.addLargest(Consistency::kVelocity, 2.3, 1, 5);
  // Each of five may raise a hundredth of the alarms: 2.576 sigma.
  EXPECT_NEAR(std::sqrt(resultOf(tests).limit), 2.576, 1e-3);
  EXPECT_FALSE(tests.failed(Consistency::kVelocity));
  tests.addLargest(Consistency::kVelocity, 2.3, 1, 1);
  EXPECT_TRUE(tests.failed(Consistency::kVelocity));
}

TEST(ConsistencyTests, ARatioFromElsewhereHasTheVarianceThatBelongsToIt) {
  ConsistencyTests tests(0.05);
  tests.begin();
  tests.addRatio(Consistency::kVelocity, 6, 9, 25);
  EXPECT_NEAR(resultOf(tests).variance, 4, 1e-12);
  EXPECT_EQ(resultOf(tests).ratio, 9);
  EXPECT_EQ(resultOf(tests).limit, 25);
}

TEST(ConsistencyTests, WhatIsNotKnownIsNotTested) {
  ConsistencyTests tests(0.05);
  const auto isTested = [&](const auto& add) {
    tests.begin();
    add();
    return resultOf(tests).possible();
  };
  const double nan = std::nan("");
  EXPECT_FALSE(isTested([&] { tests.add(Consistency::kVelocity, nan, 1); }));
  EXPECT_FALSE(isTested([&] { tests.add(Consistency::kVelocity, 1, nan); }));
  EXPECT_FALSE(isTested([&] { tests.add(Consistency::kVelocity, 1, 0); }));
  EXPECT_FALSE(isTested(
      [&] { tests.add(Consistency::kVelocity, Eigen::Vector2d(nan, 0), Eigen::Matrix2d::Identity()); }));
  EXPECT_TRUE(isTested([&] { tests.add(Consistency::kVelocity, 1, 1); }));
  tests.begin();
  EXPECT_FALSE(resultOf(tests).possible()) << "that was the pair before";
}

TEST(ConsistencyTests, CountsAnewAfterAReset) {
  ConsistencyTests tests(0.05);
  const auto failuresInARow = [&] {
    tests.begin();
    tests.add(Consistency::kVelocity, 3, 1);
    tests.finish();
    return resultOf(tests).consecutive_failures;
  };
  EXPECT_EQ(failuresInARow(), 1);
  EXPECT_EQ(failuresInARow(), 2);
  tests.reset();
  EXPECT_EQ(failuresInARow(), 1);
  EXPECT_EQ(resultOf(tests).name, "velocity");
}

}  // namespace
}  // namespace uav_landing
