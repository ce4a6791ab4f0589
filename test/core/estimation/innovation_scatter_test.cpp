#include "estimation/innovation_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing {
namespace {

TEST(InnovationScatter, IsThatOfTheClaimsWhereTheyAreTrueAndTellsThoseThatAreNot) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto factorOf = [&](double stddev, InnovationScatter& scatter) {
    double sum = 0;
    for (int i = 0; i < 400; ++i) {
      scatter.add(std::pow(stddev * normal(random), 2));
      sum += scatter.factor();
    }
    return sum / 400;
  };
  InnovationScatter honest(25), timid(25), bold(25);
  EXPECT_LT(factorOf(1, honest), 1.05);
  EXPECT_EQ(factorOf(0.5, timid), 1);
  const double factor = factorOf(2.5, bold);
  EXPECT_GT(factor, 3) << "of 6.25, as far as twenty pairs make it certain";
  EXPECT_LT(factor, 6.25);
}

TEST(InnovationScatter, OneWrongPairSaysNothingOfTheOthers) {
  InnovationScatter scatter(25);
  for (int i = 0; i < 20; ++i) scatter.add(i == 10 ? 1e6 : 0.5);
  EXPECT_LT(scatter.factor(), 1.25);
  scatter.reset();
  EXPECT_EQ(scatter.factor(), 1);
}

}  // namespace
}  // namespace uav_landing
