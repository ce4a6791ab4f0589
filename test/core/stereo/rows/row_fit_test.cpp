#include "stereo/rows/row_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rig/rig_rotation.h"
#include "support/consistency.h"
#include "support/rigs.h"

namespace uav_landing::row_fit {
namespace {

constexpr double kStddev = 0.1;  // pixels
const StereoRig& rig() {
  static const StereoRig rig = test::usualRig();
  return rig;
}

/// Rows of random corners of the ground, moved by a rotation and a direction of the baseline (rad).
template <int N>
std::vector<RowShift> rowsOf(const Eigen::Matrix<double, N, 1>& truth, std::mt19937& random, double noise,
                             int count = 150) {
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  std::vector<RowShift> rows;
  for (int i = 0; i < count; ++i) {
    const double u = 640 * uniform(random), v = 480 * uniform(random);
    const double disparity = 2 + 0.05 * v + 4 * uniform(random);
    RowShift row;
    row.by << verticalDisparityByRotation(rig(), u - disparity, v),
        verticalDisparityByBaseline(rig(), disparity, v);
    row.shift = row.by.head<N>().dot(truth) + noise * normal(random);
    row.stddev = kStddev;
    row.below_centre = v - rig().cy;
    row.cell = imageCell(rig(), u, v);
    rows.push_back(row);
  }
  return rows;
}

using Vector3 = Eigen::Matrix<double, 3, 1>;
using Vector5 = Eigen::Matrix<double, 5, 1>;
const Vector3 kRotation(1e-3, -2e-3, 1.5e-3);
const Vector5 kAll = (Vector5() << kRotation, 0.01, -0.02).finished();

template <int N>
double meanNees(const Eigen::Matrix<double, N, 1>& truth, int runs) {
  std::mt19937 random(3);
  double nees = 0;
  for (int run = 0; run < runs; ++run) {
    const Expected<RowFit<N>> fit = fitRows<N>(rowsOf<N>(truth, random, kStddev));
    EXPECT_TRUE(fit);
    if (!fit) return kUnknown;
    const Eigen::Matrix<double, N, 1> error = fit->value - truth;
    nees += error.dot(fit->covariance.inverse() * error) / runs;
  }
  return nees;
}

TEST(RowFit, ClaimsTheScatterOfIndependentRows) {
  constexpr int kRuns = 400;
  // Robust weights and a scale that never goes below one make the claim a little larger than the scatter.
  constexpr double kLeastShare = 0.65;
  const auto expect = [&](double nees, int dof) {
    const double tolerance = test::chiSquareMeanTolerance(kRuns, dof);
    EXPECT_LT(nees, dof + tolerance);
    EXPECT_GT(nees, kLeastShare * dof - tolerance);
  };
  expect(meanNees<3>(kRotation, kRuns), 3);
  expect(meanNees<5>(kAll, kRuns), 5);
}

/// By how much a small error of all rows moves what is fitted.
template <class Error>
Vector5 movedBy(const std::vector<RowShift>& rows, const Vector5& fitted, const Error& error) {
  std::vector<RowShift> wrong = rows;
  for (RowShift& row : wrong) row.shift += error(row);
  return fitRows<5>(wrong)->value - fitted;
}

constexpr double kSmall = 1e-4;  // so that no row loses weight by it

TEST(RowFit, FocalVarianceIsByHowMuchAWrongFocalLengthMovesTheFit) {
  std::mt19937 random(4);
  const std::vector<RowShift> rows = rowsOf<5>(kAll, random, 0);
  const Expected<RowFit<5>> fit = fitRows<5>(rows);
  ASSERT_TRUE(fit);
  // Longer by a share, it moves rows away from the centre by that share.
  const Vector5 moved =
      movedBy(rows, fit->value, [](const RowShift& row) { return kSmall * 1e-2 * row.below_centre; });
  const Eigen::Matrix<double, 5, 5> expected = moved * moved.transpose();
  EXPECT_LT((focalVariance<5>(rows, *fit, kSmall * 1e-2) - expected).norm(), 0.01 * expected.norm());
}

TEST(RowFit, CommonVarianceIsByHowMuchPartsOfTheImageMoveTheFit) {
  std::mt19937 random(5);
  const std::vector<RowShift> rows = rowsOf<5>(kAll, random, 0);
  const Expected<RowFit<5>> fit = fitRows<5>(rows);
  ASSERT_TRUE(fit);
  Eigen::Matrix<double, 5, 5> expected = Eigen::Matrix<double, 5, 5>::Zero();
  for (int cell = 0; cell < kImageCells; ++cell) {
    const Vector5 moved =
        movedBy(rows, fit->value, [cell](const RowShift& row) { return row.cell == cell ? kSmall : 0.0; });
    expected += moved * moved.transpose();
  }
  EXPECT_LT((commonVariance<5>(rows, *fit, kSmall) - expected).norm(), 0.01 * expected.norm());
}

TEST(RowFit, SharedVarianceIsWhatRowsOfAPartOfTheImageScatterTogether) {
  constexpr int kRuns = 300;
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  double squares = 0, independent = 0, shared = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<RowShift> rows = rowsOf<3>(kRotation, random, 0.5 * kStddev, 600);
    std::array<double, kImageCells> off;
    for (double& one : off) one = kStddev * normal(random);
    for (RowShift& row : rows) row.shift += off[row.cell];
    const Expected<RowFit<3>> fit = fitRows<3>(rows);
    ASSERT_TRUE(fit);
    squares += std::pow(fit->value.x() - kRotation.x(), 2) / kRuns;
    independent += fit->covariance(0, 0) / kRuns;
    shared += sharedVariance<3>(rows, *fit)(0, 0) / kRuns;
  }
  EXPECT_GT(squares, 5 * independent) << "rows of a part have hardly anything in common";
  EXPECT_GT(independent + shared, 0.4 * squares) << "few parts make it too small, but not by that";
  EXPECT_LT(independent + shared, 1.3 * squares);
}

TEST(RowFit, NeedsTwentyRowsThatAgree) {
  std::mt19937 random(7);
  EXPECT_FALSE(fitRows<3>(rowsOf<3>(kRotation, random, 0, 19)));
  EXPECT_TRUE(fitRows<3>(rowsOf<3>(kRotation, random, 0, 20)));
}

}  // namespace
}  // namespace uav_landing::row_fit
