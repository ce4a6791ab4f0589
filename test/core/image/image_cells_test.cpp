#include "image/input/image_cells.h"

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

TEST(ClusterCovariance, IsOfTheProductsOfDifferentPointsOfAPart) {
  const Eigen::Vector2d a(1, 2), b(0.5, -1);
  ClusterCovariance<2> together, apart, against;
  together.add(3, a);
  together.add(3, a);
  together.add(5, b);
  apart.add(3, a);
  apart.add(4, a);
  against.add(3, a);
  against.add(3, -a);
  EXPECT_LT((together.shared() - 2 * a * a.transpose()).norm(), 1e-12);
  EXPECT_LT(apart.shared().norm(), 1e-12);
  EXPECT_LT(against.shared().norm(), 1e-12) << "no variance is negative";
}

}  // namespace
}  // namespace uav_landing
