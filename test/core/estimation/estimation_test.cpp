#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "estimation/limits.h"
#include "estimation/ransac.h"
#include "estimation/robust.h"

namespace uav_landing {
namespace {

TEST(Sigmas, CompareADifferenceWithItsVarianceAndARatioWithTheSquare) {
  constexpr Sigmas limit(3);
  EXPECT_TRUE(limit.admits(5.9, 4));
  EXPECT_FALSE(limit.admits(-6.1, 4));
  EXPECT_TRUE(limit.admitsRatio(8.9));
  EXPECT_FALSE(limit.admitsRatio(9.1));
  EXPECT_DOUBLE_EQ(limit.bound(4), 6);
}

TEST(Sigmas, AdmitNothingThatIsNotKnown) {
  EXPECT_FALSE(Sigmas(3).admits(std::nan(""), 1));
  EXPECT_FALSE(Sigmas(3).admits(1, std::nan("")));
}

// Share of the variance of the mean that least squares has, of normal errors.
double efficiencyOfTukey(double end) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr int kTrials = 4000, kCount = 40;
  double by_mean = 0, by_tukey = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> errors(kCount);
    double mean = 0;
    for (double& error : errors) mean += (error = normal(random)) / kCount;
    double location = mean;
    for (int iteration = 0; iteration < 10; ++iteration) {
      double sum = 0, weights = 0;
      for (const double error : errors) {
        const double weight = std::pow(tukeyRoot((error - location) / end), 2);
        sum += weight * error;
        weights += weight;
      }
      location = sum / weights;
    }
    by_mean += mean * mean;
    by_tukey += location * location;
  }
  return by_mean / by_tukey;
}

TEST(Tukey, IsAsEfficientAsItsConstantSays) {
  EXPECT_NEAR(efficiencyOfTukey(TukeyEnd::kEfficient), 0.95, 0.02);
  EXPECT_NEAR(efficiencyOfTukey(TukeyEnd::kDisparity), 0.91, 0.02);
}

TEST(Tukey, GivesNoWeightBeyondTheEnd) {
  EXPECT_EQ(tukeyRoot(0), 1);
  EXPECT_DOUBLE_EQ(tukeyRoot(-0.5), 0.75);
  EXPECT_EQ(tukeyRoot(1), 0);
  EXPECT_EQ(tukeyRoot(-1.5), 0);
}

TEST(RobustStddev, IsThatOfNormalErrorsWhateverAThirdOfThemIs) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 3);
  std::vector<double> sizes;
  for (int i = 0; i < 20000; ++i) sizes.push_back(std::abs(normal(random)));
  EXPECT_NEAR(robustStddev(sizes), 3, 0.1);
}

int drawsUntilSure(RansacOptions options, double share, int every) {
  RansacBudget budget(options);
  budget.found(share);
  int draws = 0;
  for (; budget.goesOn(); ++draws)
    if (draws % every == 0) budget.count();
  return draws;
}

TEST(RansacBudget, DrawsUntilASampleWithoutOutliersMustHaveBeenAmongThem) {
  RansacOptions options;
  options.most = 1000;
  // Half of the measurements are right, an eighth of the triples: 0.875 ^ n < 0.001.
  EXPECT_EQ(drawsUntilSure(options, 0.5, 1), 52);
  options.of_draws = 0.5;
  EXPECT_EQ(drawsUntilSure(options, 0.5, 1), 104);
  options.sample = 1;
  // 0.5 ^ (n / 2) < 0.001.
  EXPECT_EQ(drawsUntilSure(options, 0.5, 1), 20);
}

TEST(RansacBudget, EndsWhateverIsFound) {
  RansacOptions options;
  options.most = 30;
  EXPECT_EQ(drawsUntilSure(options, 0, 1), 30);
  options.draws_each = 20;
  EXPECT_EQ(drawsUntilSure(options, 0, 10000), 600) << "most draws give no candidate";
  EXPECT_LE(drawsUntilSure(options, 1, 1), 2) << "all are right";
}

}  // namespace
}  // namespace uav_landing
