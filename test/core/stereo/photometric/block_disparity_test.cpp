#include "stereo/photometric/block_disparity.h"

#include <gtest/gtest.h>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

const StereoRig kRig = test::makeRig(640, 480, 1.0);
const PlaneVector kPlane({0, 0.1, 0.01});

ShiftMatch matchWith(double shift) { return {200, 300, shift, 0.1, 0, 3, true, true}; }

BlockDisparity disparityWith(double shift, const Eigen::Vector3d& w = Eigen::Vector3d::Zero()) {
  return disparityOf(matchWith(shift), kRig, ShiftModel(kRig, kPlane), w);
}

TEST(BlockDisparity, IsThePlanesAndTheShift) {
  const double plane = kPlane.disparity(kRig, 200, 300);
  EXPECT_NEAR(disparityWith(0).sample.disparity, plane, 1e-9);
  EXPECT_NEAR(disparityWith(0.5).sample.disparity, plane + 0.5, 1e-9) << "no slope along the rows";
  EXPECT_EQ(disparityWith(0.5).blocks, 3);
}

TEST(BlockDisparity, AShiftThatIsTooLargeToEitherSideMeansNothing) {
  for (const double shift : {-1.4, 0.0, 1.4}) EXPECT_TRUE(disparityWith(shift).alike) << shift;
  for (const double shift : {-1.6, 1.6}) EXPECT_FALSE(disparityWith(shift).alike) << shift;
}

TEST(BlockDisparity, RowsThatAreOffShowNearerGround) {
  // The right camera rolls by 1 mrad. At this pixel its rows are off by this many pixels, and the plane's
  // disparity grows by b per row.
  const Eigen::Vector3d w(0, 0, 1e-3);
  const BlockDisparity level = disparityWith(0), rolled = disparityWith(0, w);
  EXPECT_NEAR(rolled.sample.disparity - level.sample.disparity, -level.leak.dot(w), 1e-12);
  const double right_u = 200 - ShiftModel(kRig, kPlane).at(200, 300);
  const double row = 1e-3 * (right_u - kRig.cx_right);
  EXPECT_NEAR(std::abs(level.leak.dot(w)), std::abs(ShiftModel(kRig, kPlane).b * row), 1e-6);
}

}  // namespace
}  // namespace uav_landing
