#include "height/height_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace uav_landing {
namespace {

constexpr double kWideGate = 1e6;

TEST(HeightFilter, StartsAtTheReconstructedHeightWithSpeedZero) {
  HeightFilter filter(1.0, 5.0, kWideGate);
  EXPECT_FALSE(filter.initialised());
  filter.initialise(12.5, 0.04);
  EXPECT_TRUE(filter.initialised());
  EXPECT_DOUBLE_EQ(filter.state()[0], 12.5);
  EXPECT_DOUBLE_EQ(filter.state()[1], 0);
  EXPECT_DOUBLE_EQ(filter.covariance()(0, 0), 0.04);
  EXPECT_DOUBLE_EQ(filter.covariance()(1, 1), 25.0);
}

TEST(HeightFilter, PredictionAddsTheNoiseOfARandomAcceleration) {
  // By hand from eq (7): P00 + 2 T P01 + T^2 P11 + s^2 T^4/4 and so on, for P = diag(0.04, 25), T = 0.5, s
  // = 2.
  HeightFilter filter(2.0, 5.0, kWideGate);
  filter.initialise(10, 0.04);
  filter.predict(0.5);
  EXPECT_NEAR(filter.covariance()(0, 0), 0.04 + 0.25 * 25 + 4 * 0.0625 / 4, 1e-12);
  EXPECT_NEAR(filter.covariance()(0, 1), 0.5 * 25 + 4 * 0.125 / 2, 1e-12);
  EXPECT_NEAR(filter.covariance()(1, 1), 25 + 4 * 0.25, 1e-12);
}

/// The batch solution: least squares over the whole history with the accelerations as unknowns too.
struct Batch {
  Eigen::Vector2d state;
  Eigen::Matrix2d covariance;
};
Batch solveBatch(const std::vector<double>& T, const std::vector<double>& heights,
                 const std::vector<double>& speeds, double height_stddev, double speed_stddev,
                 double acceleration_stddev, double initial_speed_stddev) {
  const int n = static_cast<int>(heights.size());
  const int unknowns = 2 + n - 1;  // first height and speed, then one acceleration per interval
  // Rows of the current state as functions of the unknowns.
  Eigen::RowVectorXd height_row = Eigen::RowVectorXd::Unit(unknowns, 0);
  Eigen::RowVectorXd speed_row = Eigen::RowVectorXd::Unit(unknowns, 1);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  const auto observe = [&](const Eigen::RowVectorXd& row, double value, double stddev) {
    information += row.transpose() * row / (stddev * stddev);
    right += row.transpose() * value / (stddev * stddev);
  };
  observe(height_row, heights[0], height_stddev);
  observe(speed_row, 0, initial_speed_stddev);
  for (int k = 1; k < n; ++k) {
    const Eigen::RowVectorXd acceleration = Eigen::RowVectorXd::Unit(unknowns, 1 + k);
    observe(acceleration, 0, acceleration_stddev);
    height_row += T[k - 1] * speed_row + 0.5 * T[k - 1] * T[k - 1] * acceleration;
    speed_row += T[k - 1] * acceleration;
    observe(height_row, heights[k], height_stddev);
    observe(speed_row, speeds[k], speed_stddev);
  }
  const Eigen::MatrixXd covariance = information.inverse();
  const Eigen::VectorXd solution = covariance * right;
  Eigen::MatrixXd rows(2, unknowns);
  rows << height_row, speed_row;
  return {rows * solution, rows * covariance * rows.transpose()};
}

TEST(HeightFilter, EqualsTheBatchLeastSquaresSolution) {
  const std::vector<double> T = {0.1, 0.12, 0.05, 0.2, 0.1};
  const std::vector<double> heights = {20.1, 19.9, 19.6, 19.62, 19.3, 19.05};
  const std::vector<double> speeds = {0, -1.5, -1.9, -1.6, -2.1, -1.7};
  const double height_stddev = 0.1, speed_stddev = 0.3, acceleration_stddev = 1.5, initial_speed_stddev = 5;

  HeightFilter filter(acceleration_stddev, initial_speed_stddev, kWideGate);
  filter.initialise(heights[0], height_stddev * height_stddev);
  for (std::size_t k = 1; k < heights.size(); ++k) {
    filter.predict(T[k - 1]);
    EXPECT_TRUE(filter.update(heights[k], height_stddev * height_stddev).accepted);
    EXPECT_TRUE(filter.updateSpeed(speeds[k], speed_stddev * speed_stddev).accepted);
  }
  const Batch batch =
      solveBatch(T, heights, speeds, height_stddev, speed_stddev, acceleration_stddev, initial_speed_stddev);
  EXPECT_TRUE(filter.state().isApprox(batch.state, 1e-9)) << filter.state() << "\n" << batch.state;
  EXPECT_TRUE(filter.covariance().isApprox(batch.covariance, 1e-9));
}

TEST(HeightFilter, StaysSymmetricAndPositiveOverManyUnequalUpdates) {
  HeightFilter filter(1.5, 5.0, kWideGate);
  filter.initialise(100, 1);
  for (int k = 0; k < 20000; ++k) {
    filter.predict(k % 7 == 0 ? 0.5 : 0.02);
    filter.update(100, k % 2 == 0 ? 1e-8 : 100);
  }
  const Eigen::Matrix2d& P = filter.covariance();
  EXPECT_NEAR(P(0, 1), P(1, 0), 1e-12);
  EXPECT_GT(P(0, 0), 0);
  EXPECT_GT(P.determinant(), 0);
}

TEST(HeightFilter, RefusesAMeasurementBeyondTheGateAndStaysAsItWas) {
  HeightFilter filter(1.0, 0.1, 3.0);
  filter.initialise(10, 0.03);
  // Innovation variance 0.03 + 0.06 = 0.3^2: the gate lies at 10.9 m.
  const HeightFilter::Update refused = filter.update(10.91, 0.06);
  EXPECT_FALSE(refused.accepted);
  EXPECT_NEAR(refused.innovation, 0.91, 1e-12);
  EXPECT_NEAR(refused.innovation_variance, 0.09, 1e-12);
  EXPECT_DOUBLE_EQ(filter.state()[0], 10);
  EXPECT_DOUBLE_EQ(filter.covariance()(0, 0), 0.03);

  EXPECT_TRUE(filter.update(10.89, 0.06).accepted);
  EXPECT_NEAR(filter.state()[0], 10 + 0.89 / 3, 1e-12);
}

TEST(HeightFilter, GrantsTheBaselineWhereOnlyOneOfTwoHeightsDependsOnIt) {
  // A baseline that is known to 3 %: by 0.3 m at 10 m. Its square is in no measurement's variance.
  const CommonVariance by_images{0, 0, 0, 0.09}, by_width;
  HeightFilter filter(1.0, 0.1, 3.0);
  filter.initialise(10, 0.01, by_images);
  EXPECT_FALSE(filter.update(10.8, 0.01, by_images).accepted) << "both are wrong by the same";
  const HeightFilter::Update update = filter.update(10.8, 0.01, by_width);
  EXPECT_TRUE(update.accepted) << "0.8 m at 1 sigma of sqrt(0.01 + 0.01 + 0.09) m";
  EXPECT_NEAR(update.gate_variance, 0.11, 1e-12);
  EXPECT_NEAR(update.innovation_variance, 0.02, 1e-12);
  EXPECT_NEAR(filter.state()[0], 10.4, 1e-12) << "the gain is as before";
  filter.initialise(10, 0.01, by_width);
  EXPECT_TRUE(filter.update(10.8, 0.01, by_images).accepted);
  EXPECT_FALSE(filter.update(12, 0.01, by_width).accepted) << "beyond that as well";
}

TEST(HeightFilter, RefusesNaN) {
  HeightFilter filter(1.0, 0.1, 3.0);
  filter.initialise(10, 0.03);
  EXPECT_FALSE(filter.update(std::numeric_limits<double>::quiet_NaN(), 0.06).accepted);
  EXPECT_FALSE(filter.updateSpeed(1.0, std::numeric_limits<double>::quiet_NaN()).accepted);
  EXPECT_DOUBLE_EQ(filter.state()[0], 10);
}

TEST(HeightFilter, WhatIsCommonToAllMeasurementsDoesNotAverageOut) {
  // Level flight seen by measurements that share an error: over many flights the height is off by that error
  // and what is left of the noise.
  constexpr double kOwn = 0.1, kCommon = 0.2;
  constexpr int kFlights = 4000;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double squares = 0, claimed = 0;
  for (int flight = 0; flight < kFlights; ++flight) {
    HeightFilter filter(0.01, 0.01, kWideGate);
    const double shared = kCommon * normal(random), variance = kOwn * kOwn + kCommon * kCommon;
    filter.initialise(10 + shared + kOwn * normal(random), variance, {kCommon * kCommon});
    for (int i = 0; i < 15; ++i) {
      filter.predict(0.05);
      filter.update(10 + shared + kOwn * normal(random), variance, {kCommon * kCommon});
    }
    squares += std::pow(filter.state()[0] - 10, 2) / kFlights;
    claimed = filter.ownCovariance()(0, 0) + filter.commonVariance().total();
  }
  EXPECT_NEAR(claimed / squares, 1, 0.1);
  EXPECT_NEAR(claimed, kCommon * kCommon, 0.25 * kOwn * kOwn);
}

TEST(HeightFilter, ClaimsOfWhatIsCommonWhatItsMeasurementsBroughtIn) {
  // One cause, by which some pairs are wrong by more than others: the last one is uncertain by it as hardly
  // any before.
  constexpr double kOwn = 0.05, kLittle = 0.1, kMuch = 0.8;
  constexpr int kFlights = 4000;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double squares = 0, claimed = 0;
  for (int flight = 0; flight < kFlights; ++flight) {
    HeightFilter filter(1, 0.5, kWideGate);
    const double cause = normal(random);
    for (int i = 0; i <= 20; ++i) {
      const double common = i % 10 == 0 ? kMuch : kLittle;
      const double height = 10 + common * cause + kOwn * normal(random);
      const double variance = kOwn * kOwn + common * common;
      if (i == 0) filter.initialise(height, variance, {common * common});
      filter.predict(0.05);
      filter.update(height, variance, {common * common});
      filter.updateSpeed(0.1 * normal(random), 0.01);
    }
    squares += std::pow(filter.state()[0] - 10, 2) / kFlights;
    claimed = filter.ownCovariance()(0, 0) + filter.commonVariance().total();
  }
  EXPECT_NEAR(claimed / squares, 1, 0.1);
  EXPECT_LT(claimed, 4 * kLittle * kLittle);
}

TEST(HeightFilter, ClaimsAtLeastWhatLastsWhenAnotherCauseEnds) {
  // A large error of one cause, which ends, leaves a speed behind that takes its share through zero: what
  // another cause brought in is still there.
  constexpr double kOwn = 0.02, kLasting = 0.03, kBend = 0.3;
  constexpr int kFlights = 4000, kLong = 60, kAfter = 15;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> squares(kAfter, 0), claimed(kAfter, 0);
  for (int flight = 0; flight < kFlights; ++flight) {
    HeightFilter filter(1, 0.5, kWideGate);
    const double lasting = kLasting * normal(random), bend = kBend * normal(random);
    for (int i = 0; i < kLong + kAfter; ++i) {
      const bool bends = i < kLong;
      const double height = 10 + lasting + (bends ? bend : 0) + kOwn * normal(random);
      const CommonVariance common{kLasting * kLasting, bends ? kBend * kBend : 0, 0};
      if (i == 0) filter.initialise(height, kOwn * kOwn + common.total(), common);
      filter.predict(0.033);
      filter.update(height, kOwn * kOwn + common.total(), common);
      if (bends) continue;
      squares[i - kLong] += std::pow(filter.state()[0] - 10, 2) / kFlights;
      claimed[i - kLong] = filter.ownCovariance()(0, 0) + filter.commonVariance().total();
    }
  }
  for (int i = 0; i < kAfter; ++i) {
    EXPECT_NEAR(claimed[i] / squares[i], 1, 0.12) << i;
    EXPECT_GE(claimed[i], 0.99 * kLasting * kLasting) << i;
  }
}

}  // namespace
}  // namespace uav_landing
