#include "stereo/photometric/aligned_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::makePose;
using test::Pose;

/// Textured ground, seen without noise.
struct Ground {
  StereoRig rig = test::makeRig(320, 240, 0.5);
  cv::Mat left_mask{rig.size, CV_8U, cv::Scalar(255)}, right_mask = left_mask.clone();
  Pose pose = makePose(3, -8, 4);
  Eigen::Vector3d truth = pose.down() / pose.height();
  cv::Mat left = GroundRenderer(2).left(rig, pose, {1, 0, 0});
  cv::Mat right;

  Ground() { GroundRenderer(2).right(rig, pose, {1, 0, 0}).convertTo(right, CV_32F); }
  ShiftModel off(double pixels) const {
    return {rig, PlaneVector(truth + Eigen::Vector3d(0, 0, pixels / rig.fb()))};
  }
  AlignedRows aligned(double pixels_off) const {
    AlignedRows rows(left_mask, right_mask);
    rows.begin(left, off(0), 1 + rig.principalOffset());
    rows.align(right, off(pixels_off));
    return rows;
  }
};

/// Mean difference of the images where both see the ground, grey levels.
double difference(const AlignedRows& rows) {
  double sum = 0;
  int count = 0;
  for (int row = 0; row < rows.left().rows; ++row) {
    for (int u = rows.seen(row).start; u < rows.seen(row).end; ++u, ++count)
      sum += std::abs(rows.left().at<float>(row, u) - rows.right().at<float>(row, u));
  }
  return sum / count;
}

TEST(AlignedRows, PutTheRightImageOnTheLeftOne) {
  const Ground ground;
  EXPECT_LT(difference(ground.aligned(0)), 1);
  EXPECT_GT(difference(ground.aligned(1)), 3);
  EXPECT_GT(difference(ground.aligned(-1)), 3);
}

TEST(AlignedRows, SeeGroundOnly) {
  const Ground ground;
  const AlignedRows rows = ground.aligned(0);
  ASSERT_GT(rows.left().rows, 100);
  EXPECT_EQ(rows.firstRow() + rows.left().rows, ground.rig.size.height);
  for (int row = 0; row < rows.left().rows; ++row) {
    const int v = rows.firstRow() + row;
    for (const int u : {rows.seen(row).start, rows.seen(row).end - 1}) {
      if (rows.seen(row).empty()) continue;
      const double disparity = ground.rig.fb() * ground.truth.dot(ground.rig.ray(u, v));
      EXPECT_GE(disparity, 1) << u << ' ' << v;
      const double column = u - disparity - ground.rig.principalOffset();
      EXPECT_GE(column, 1) << u << ' ' << v;
      EXPECT_LE(column, ground.rig.size.width - 2) << u << ' ' << v;
    }
  }
}

TEST(AlignedRows, AreFilledUpWithTheLastPixelThatBothSee) {
  Ground ground;
  ground.left_mask.colRange(0, 60) = 0;
  ground.right_mask.colRange(290, 320) = 0;
  const AlignedRows rows = ground.aligned(0);
  for (int row = 40; row < rows.left().rows; ++row) {
    const cv::Range seen = rows.seen(row);
    ASSERT_FALSE(seen.empty());
    EXPECT_GE(seen.start, 60);
    const double right_end = seen.end - 1 - ground.off(0).at(seen.end - 1, rows.firstRow() + row);
    EXPECT_LT(right_end, 290);
    for (const cv::Mat& image : {rows.left(), rows.right()}) {
      EXPECT_EQ(image.at<float>(row, 0), image.at<float>(row, seen.start)) << row;
      EXPECT_EQ(image.at<float>(row, image.cols - 1), image.at<float>(row, seen.end - 1)) << row;
    }
  }
}

/// Masks are eroded at the image's border, and distorted pictures may have corners without a middle.
TEST(AlignedRows, AreThoseThatBothSeeAndOneRunOfEach) {
  Ground ground;
  ground.left_mask.rowRange(230, 240) = 0;
  ground.right_mask.rowRange(225, 240) = 0;
  ground.left_mask(cv::Rect(250, 200, 10, 30)) = 0;
  const AlignedRows rows = ground.aligned(0);
  EXPECT_EQ(rows.firstRow() + rows.left().rows, 225);
  EXPECT_FALSE(rows.seen(0).empty());
  EXPECT_LE(rows.seen(205 - rows.firstRow()).end, 250);
  EXPECT_GT(rows.seen(195 - rows.firstRow()).end, 260);
}

/// As after a wild step of the refinement: nothing outside the right image is read.
TEST(AlignedRows, KeepInsideTheRightImageFarFromTheFirstModel) {
  const Ground ground;
  for (const double pixels : {-400.0, -30.0, 30.0, 400.0}) {
    const AlignedRows rows = ground.aligned(pixels);
    double low = 0, high = 0;
    cv::minMaxLoc(rows.right(), &low, &high);
    EXPECT_GE(low, -40) << pixels;
    EXPECT_LE(high, 295) << pixels << ": grey levels, and what interpolation makes of edges";
  }
}

TEST(AlignedRows, AreNoneWithoutGround) {
  const Ground ground;
  AlignedRows rows(ground.left_mask, ground.right_mask);
  // Level ground that is looked up from.
  rows.begin(ground.left, ShiftModel(ground.rig, PlaneVector({0, 0.3, -0.4})), 1);
  EXPECT_EQ(rows.left().rows, 0);
  rows.align(ground.right, ground.off(0));
  EXPECT_EQ(rows.right().rows, 0);
}

}  // namespace
}  // namespace uav_landing
