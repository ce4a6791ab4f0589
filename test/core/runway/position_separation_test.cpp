#include "runway/position/position_separation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace uav_landing {
namespace {

/// A risk of 1e-5 with faults of 1e-3: quantiles of both sides of a normal distribution, from tables.
constexpr double kFaultFree = 4.417, kFault = 2.576;

KalmanHeightParameters risks() {
  KalmanHeightParameters parameters;
  parameters.integrity_risk = 1e-5;
  parameters.fault_probability = 1e-3;
  return parameters;
}

CentreSolutions all(double value, double variance) {
  CentreSolutions solutions;
  solutions.without.fill({value, variance});
  return solutions;
}

TEST(PositionSeparation, IsNotKnownBeforeEverySourceHasBeenLeftOut) {
  PositionSeparation separation(risks());
  CentreSolutions seen = all(0.2, 1e-4);
  seen[CentreSource::kWholeRunway] = {};
  separation.update(seen, {10, 0.01, 0.5}, 0);
  EXPECT_TRUE(std::isnan(separation.protectionLevel(2, 0.01)));
  separation.update(all(0.2, 1e-4), {10, 0.01, 0.5}, 0.1);
  EXPECT_FALSE(std::isnan(separation.protectionLevel(2, 0.01)));
  separation.update(all(0.2, 1e-4), {10, 0.01, kUnknown}, 0.1);
  EXPECT_TRUE(std::isnan(separation.protectionLevel(2, 0.01))) << "without a protection level of the height";
}

TEST(PositionSeparation, CoversTheDistanceToTheSolutionWithoutASource) {
  PositionSeparation separation(risks());
  CentreSolutions seen = all(0.2, 1e-4);
  seen[CentreSource::kLeftEdge] = {0.35, 9e-4};
  separation.update(seen, {10, 0, 0}, 0);
  // 3.5 m, of which 1 sigma is 0.3 m.
  EXPECT_NEAR(separation.protectionLevel(2, 0.01), 1.5 + kFault * 0.3, 1e-3);
}

TEST(PositionSeparation, WithoutAContradictionItIsAboutTheClaim) {
  PositionSeparation separation(risks());
  separation.update(all(0.2, 1e-4), {10, 0, 0}, 0);
  EXPECT_NEAR(separation.protectionLevel(2, 0.01), kFaultFree * 0.1, 1e-3);
}

TEST(PositionSeparation, AWrongHeightScalesIt) {
  for (const int side : {1, -1}) {
    PositionSeparation separation(risks());
    separation.update(all(side * 2, 1e-6), {10, 0, 1.5}, 0);
    EXPECT_NEAR(separation.protectionLevel(side * 20, 1e-4), 0.15 * 20 + kFault * 0.01, 1e-3);
  }
}

TEST(PositionSeparation, GrowsWhileNothingIsSeenUntilItIsForgotten) {
  PositionSeparation separation(risks());
  separation.update(all(0.2, 1e-4), {10, 0, 0}, 0);
  for (int i = 0; i < 10; ++i) separation.predict(0.5, 0.05);
  // 0.1 m, of which a half has to do with the measurement that is past, and 10 steps that err alike.
  EXPECT_NEAR(separation.protectionLevel(7, 0.01),
              kFault * std::sqrt(0.005 + std::pow(std::sqrt(0.005) + 0.5, 2)), 0.01);
  separation.forgetAbove(0.3);
  EXPECT_TRUE(std::isnan(separation.protectionLevel(7, 0.01)));
}

/// Half of the runs have one wrong source, much more often than the level expects.
TEST(PositionSeparation, HoldsWhicheverSourceIsWrong) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> wrong(-3, 3);
  int beyond = 0;
  constexpr int kRuns = 4000;
  for (int run = 0; run < kRuns; ++run) {
    // Six measurements of the same stddev. The position is their mean.
    constexpr double kStddev = 0.1;
    double measured[kCentreSources], mean = 0;
    for (double& value : measured) value = kStddev * normal(random);
    if (run % 2 == 0) measured[run / 2 % kCentreSources] += wrong(random);
    for (const double value : measured) mean += value / kCentreSources;
    CentreSolutions seen;
    for (int i = 0; i < kCentreSources; ++i)
      seen.without[i] = {(kCentreSources * mean - measured[i]) / (kCentreSources - 1),
                         kStddev * kStddev / (kCentreSources - 1)};
    PositionSeparation separation(risks());
    separation.update(seen, {1, 0, 0}, 0);
    beyond += std::abs(mean) > separation.protectionLevel(mean, kStddev * kStddev / kCentreSources) ? 1 : 0;
  }
  // Beyond its 99 % without a contradiction; the separation itself only adds to it.
  EXPECT_LT(beyond, 0.01 * kRuns);
}

}  // namespace
}  // namespace uav_landing
