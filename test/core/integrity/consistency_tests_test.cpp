#include "uav_landing/integrity/consistency_tests.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace uav_landing
