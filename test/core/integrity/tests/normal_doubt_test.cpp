#include "integrity/tests/normal_doubt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace uav_landing {
namespace {

constexpr double kPrior = 1e-3, kMemory = 1.0;
const Eigen::Vector3d kTurn(0, 0, 0.01);

double probabilityAfter(std::initializer_list<double> ratios, double prior = kPrior) {
  NormalDoubt doubt(prior, kMemory);
  double stamp = 10;
  for (const double ratio : ratios) doubt.add(stamp += 0.05, ratio, kTurn, 1e-6, false);
  return doubt.probability(stamp);
}

TEST(NormalDoubt, IsThePriorWithoutAContradictionAndEvenOddsWhereNoiseIsAsUnlikelyAsAFault) {
  EXPECT_NEAR(probabilityAfter({0, 0, 0}), kPrior, 1e-12);
  const double even = 2 * std::log(999.0);  // 3.7 sigma
  EXPECT_NEAR(probabilityAfter({even, even, even}), 0.5, 1e-12);
  EXPECT_NEAR(probabilityAfter({9, 9, 9}), 0.0827, 1e-3) << "3 sigma: 90 times as likely by a fault";
  EXPECT_NEAR(probabilityAfter({1e4, 1e4, 1e4}), 1, 1e-12);
  EXPECT_NEAR(probabilityAfter({0, 0, 0}, 1), 1, 1e-12);
}

TEST(NormalDoubt, OnePairOfThreeThatIsOfAnotherMindDoesNotCount) {
  EXPECT_NEAR(probabilityAfter({0, 0, 100}), kPrior, 1e-12);
  EXPECT_NEAR(probabilityAfter({0, 100}), kPrior, 1e-12);
  EXPECT_NEAR(probabilityAfter({100}), 1, 1e-6) << "nothing before it";
  EXPECT_NEAR(probabilityAfter({0, 0, 100, 100}), 1, 1e-6);
  EXPECT_NEAR(probabilityAfter({100, 100, 100, 0}), 1, 1e-6) << "one that says nothing";
  EXPECT_NEAR(probabilityAfter({100, 100, 0, 0}), kPrior, 1e-12);
}

TEST(NormalDoubt, OfAPlaneThatHasTurnedThePairsBeforeSayNothing) {
  NormalDoubt doubt(kPrior, kMemory);
  for (int i = 0; i < 3; ++i) doubt.add(0.05 * i, 0, kTurn, 1e-6, false);
  doubt.add(0.15, 100, kTurn, 1e-6, true);
  EXPECT_NEAR(doubt.probability(0.15), 1, 1e-6);
}

TEST(NormalDoubt, LastsForAsLongAsItIsRememberedWhereNoVanishingPointIsSeen) {
  NormalDoubt doubt(kPrior, kMemory);
  EXPECT_EQ(doubt.probability(1), 0);
  doubt.add(1, std::numeric_limits<double>::quiet_NaN(), kTurn, 1e-6, false);
  EXPECT_EQ(doubt.probability(1), 0) << "a test that was not made";
  for (int i = 0; i < 3; ++i) {
    doubt.add(1 + 0.05 * i, 100, kTurn, 1e-6, false);
    EXPECT_NEAR(doubt.probability(1 + 0.05 * i), 1, 1e-6);
    EXPECT_NEAR(doubt.probability(1.04 + 0.05 * i), i < 2 ? 0 : 1, 1e-6) << "one alone may be wrong";
  }
  EXPECT_NEAR(doubt.probability(2.05), 1, 1e-6);
  EXPECT_EQ(doubt.turn(), kTurn);
  EXPECT_EQ(doubt.probability(2.15), 0);
  doubt.add(3, 0, kTurn, 1e-6, false);
  EXPECT_NEAR(doubt.probability(3), kPrior, 1e-12) << "what was before is forgotten";
}

TEST(NormalDoubt, HasTheVarianceOfTheLastPair) {
  NormalDoubt doubt(kPrior, kMemory);
  for (int i = 0; i < 3; ++i) doubt.add(1 + 0.05 * i, 100, kTurn, 1e-6 * (i + 1), false);
  EXPECT_EQ(doubt.variance(), 3e-6);
}

}  // namespace
}  // namespace uav_landing
