#include "image/image_cells.h"

#include <gtest/gtest.h>

#include "support/rigs.h"

namespace uav_landing {
namespace {

TEST(ImageCell, NumbersThePartsByRowsAndKnowsNoOthers) {
  const StereoRig rig = test::usualRig();
  EXPECT_EQ(imageCell(rig, 0, 0), 0);
  EXPECT_EQ(imageCell(rig, 170, 0), 1);
  EXPECT_EQ(imageCell(rig, 0, 170), kCellsAcross);
  EXPECT_EQ(imageCell(rig, 639, 479), kImageCells - 1);
  EXPECT_EQ(imageCell(rig, 700, 600), kImageCells - 1);
  EXPECT_EQ(imageCell(rig, -5, -5), 0);
}

TEST(SharedPulls, AreTheProductsOfDifferentPointsOfAPart) {
  const Eigen::Vector2d a(1, 2), b(0.5, -1);
  const Eigen::Matrix2d all = Eigen::Matrix2d::Identity();
  SharedPulls<2> together, apart, against;
  together.add(3, a);
  together.add(3, a);
  together.add(5, b);
  apart.add(3, a);
  apart.add(4, a);
  against.add(3, a);
  against.add(3, -a);
  EXPECT_LT((together.variance<2>(all) - 2 * a * a.transpose()).norm(), 1e-12);
  EXPECT_LT(apart.variance<2>(all).norm(), 1e-12);
  EXPECT_LT(against.variance<2>(all).norm(), 1e-12) << "no variance is negative";
  Eigen::Matrix<double, 1, 2> by;
  by << 3, 0;
  EXPECT_NEAR(together.variance<1>(by)(0, 0), 2 * 9, 1e-12);
}

}  // namespace
}  // namespace uav_landing
