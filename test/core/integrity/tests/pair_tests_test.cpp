#include "integrity/tests/pair_tests.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrity/tests/solution_separation.h"
#include "support/documentation.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {
namespace {

TEST(PairTests, LimitsAreThoseOfTheChiSquareTable) {
  EXPECT_NEAR(chiSquareLimit(0.05, 1), 3.841, 1e-3);
  EXPECT_NEAR(chiSquareLimit(0.001, 2), 13.816, 1e-3);
  EXPECT_NEAR(normalQuantile(0.05), 1.960, 1e-3);
  EXPECT_NEAR(normalQuantile(1e-5), 4.417, 1e-3);
}

TEST(PairTests, CountsFailuresInARowAndForgetsThemAtTheNextPairThatPasses) {
  FailureCounts counts;
  int expected = 0;
  for (const double difference : {3.0, 3.0, 1.0}) {
    PairTests tests(0.05, 5);
    tests.add(IntegrityTest::kRunwayWidth, difference, 1.0);
    const std::vector<TestResult> results = counts.count(tests);
    expected = difference > 1.96 ? expected + 1 : 0;
    const TestResult& width = results[static_cast<int>(IntegrityTest::kRunwayWidth)];
    EXPECT_EQ(width.name, "runway_width");
    EXPECT_EQ(width.failed(), difference > 1.96);
    EXPECT_FALSE(results[static_cast<int>(IntegrityTest::kTilt)].possible());
    EXPECT_EQ(width.consecutive_failures, expected);
    EXPECT_EQ(failedTests(results), difference > 1.96 ? "runway_width" : "");
  }
}

const TestResult& resultOf(const PairTests& tests) { return tests.result(IntegrityTest::kVelocity); }

TEST(PairTests, SeveralNumbersAreTestedByTheirCovariance) {
  PairTests tests(0.05, 5);
  Eigen::Matrix2d covariance;
  covariance << 4, 2, 2, 3;
  tests.add(IntegrityTest::kVelocity, Eigen::Vector2d(3, 4), covariance);
  // The inverse is (3, -2; -2, 4) / 8, so that the ratio is (3 * 9 - 4 * 12 + 4 * 16) / 8.
  EXPECT_NEAR(resultOf(tests).ratio, 43.0 / 8, 1e-12);
  EXPECT_NEAR(resultOf(tests).difference, 5, 1e-12);
  EXPECT_NEAR(resultOf(tests).variance, 3.5, 1e-12) << "the mean of both";
  EXPECT_NEAR(resultOf(tests).limit, 5.991, 1e-3);
  EXPECT_FALSE(tests.failed(IntegrityTest::kVelocity));
  tests.add(IntegrityTest::kVelocity, Eigen::Vector2d(4, -4), covariance);
  EXPECT_TRUE(tests.failed(IntegrityTest::kVelocity)) << "against the correlation";
}

TEST(PairTests, WhatIsWrongInOneDirectionOnlyPassesInTheOther) {
  for (const double sign : {-1.0, 1.0}) {
    PairTests tests(0.05, 5);
    tests.addOneSided(IntegrityTest::kVelocity, sign * 6, 4);
    EXPECT_EQ(resultOf(tests).difference, sign * 6);
    EXPECT_EQ(resultOf(tests).ratio, sign < 0 ? 0 : 9);
    EXPECT_EQ(tests.failed(IntegrityTest::kVelocity), sign > 0);
  }
}

TEST(PairTests, TheLargestOfManyMayBeLargerForTheSameRateOfFalseAlarms) {
  PairTests tests(0.05, 5);
  tests.addLargest(IntegrityTest::kVelocity, 2.3, 1, 5);
  // Each of five may raise a hundredth of the alarms: 2.576 sigma.
  EXPECT_NEAR(std::sqrt(resultOf(tests).limit), 2.576, 1e-3);
  EXPECT_FALSE(tests.failed(IntegrityTest::kVelocity));
  tests.addLargest(IntegrityTest::kVelocity, 2.3, 1, 1);
  EXPECT_TRUE(tests.failed(IntegrityTest::kVelocity));
}

TEST(PairTests, ARatioFromElsewhereHasTheVarianceThatBelongsToIt) {
  PairTests tests(0.05, 4);
  tests.addRatio(IntegrityTest::kTilt, 6, 9);
  const TestResult& tilt = tests.result(IntegrityTest::kTilt);
  EXPECT_NEAR(tilt.variance, 4, 1e-12);
  EXPECT_EQ(tilt.ratio, 9);
  EXPECT_EQ(tilt.limit, 25) << "that of the catalogue";
  tests.addRatio(IntegrityTest::kInnovation, 6, 9);
  EXPECT_EQ(tests.result(IntegrityTest::kInnovation).limit, 16) << "the gate's";
}

TEST(PairTests, WhatIsNotKnownIsNotTested) {
  const auto isTested = [](const auto& add) {
    PairTests tests(0.05, 5);
    add(tests);
    return resultOf(tests).possible();
  };
  const double nan = std::nan("");
  EXPECT_FALSE(isTested([&](PairTests& tests) { tests.add(IntegrityTest::kVelocity, nan, 1); }));
  EXPECT_FALSE(isTested([&](PairTests& tests) { tests.add(IntegrityTest::kVelocity, 1, nan); }));
  EXPECT_FALSE(isTested([&](PairTests& tests) { tests.add(IntegrityTest::kVelocity, 1, 0); }));
  EXPECT_FALSE(isTested([&](PairTests& tests) {
    tests.add(IntegrityTest::kVelocity, Eigen::Vector2d(nan, 0), Eigen::Matrix2d::Identity());
  }));
  EXPECT_TRUE(isTested([&](PairTests& tests) { tests.add(IntegrityTest::kVelocity, 1, 1); }));
}

TEST(PairTests, TheFirstFailureIsThatOfTheStepAndConsequenceAskedFor) {
  PairTests tests(0.05, 5);
  const auto leftOut = [&] { return tests.firstFailed(TestStep::kPair, OnFailure::kPairLeftOut); };
  EXPECT_FALSE(leftOut());
  tests.add(IntegrityTest::kVelocity, 9, 1);
  tests.addRatio(IntegrityTest::kTilt, 9, 81);
  EXPECT_FALSE(leftOut()) << "one has another consequence, the other another step";
  tests.add(IntegrityTest::kImageRegions, 9, 1);
  EXPECT_EQ(leftOut(), IntegrityTest::kImageRegions);
  tests.add(IntegrityTest::kStandstill, 9, 1);
  EXPECT_EQ(leftOut(), IntegrityTest::kStandstill) << "the first one of the catalogue";
}

TEST(TestCatalogue, EveryTestStandsAtItsPlaceAndHasAName) {
  for (int i = 0; i < kIntegrityTests; ++i) {
    EXPECT_EQ(static_cast<int>(kTestCatalogue[i].test), i);
    for (int j = 0; j < i; ++j) EXPECT_STRNE(kTestCatalogue[i].name, kTestCatalogue[j].name);
  }
  EXPECT_STREQ(toString(IntegrityTest::kSinkRate), "sink_rate");
}

TEST(TestCatalogue, IsThePageInTheDocumentation) {
  test::expectPage("integrity_tests.md", integrityTestPage(), "--list-tests");
}

}  // namespace
}  // namespace uav_landing
