#include "uav_landing/geometry/camera_pair.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <string>

#include "uav_landing/image/rectification.h"

namespace uav_landing {
namespace {

/// A camera that turns a little from the raw to the rectified picture, with a lens.
CameraCalibration camera(double Tx) {
  CameraCalibration c;
  c.width = 320;
  c.height = 240;
  c.distortion_model = "plumb_bob";
  c.D = {-0.2, 0.05, 0.001, -0.002, 0};
  c.K << 255, 0, 158, 0, 256, 123, 0, 0, 1;
  c.R = Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  c.P << 250, 0, 164, Tx, 0, 250, 117, 0, 0, 0, 1, 0;
  return c;
}

struct Pair {
  CameraCalibration left = camera(0), right = camera(-100);  // 0.4 m
};

CameraPair working(const Pair& pair, bool upside_down) {
  RigParameters parameters;
  parameters.upside_down = upside_down;
  const Expected<CameraPair> made = workingPair(pair.left, pair.right, parameters);
  EXPECT_TRUE(made) << made.error().message();
  return *made;
}

/// Pixel, full resolution, of a point in the axes that P has for both cameras.
Eigen::Vector2d pixel(const CameraCalibration& c, const Eigen::Vector3d& point) {
  return (c.P * point.homogeneous()).hnormalized();
}

TEST(WorkingPair, IsTheGivenOneWhereThereIsNothingToChange) {
  Pair pair;
  pair.right.P(1, 3) = 0.05;  // level to half a thousandth
  const CameraPair made = working(pair, false);
  EXPECT_EQ(made.left, pair.left);
  EXPECT_EQ(made.right, pair.right);
}

TEST(WorkingPair, MakesRowsLevelWhereTheBaselineIsAslantInP) {
  Pair pair;
  // The right camera stands 2 mm lower and 3 mm before.
  pair.right.P.col(3) << 250 * -0.4 + 164 * -0.003, 250 * -0.002 + 117 * -0.003, -0.003;
  ASSERT_FALSE(makeStereoRig(pair.left, pair.right)) << "rows differ by half a pixel, or by more";
  const CameraPair made = working(pair, false);
  const Expected<StereoRig> rig = makeStereoRig(made.left, made.right);
  ASSERT_TRUE(rig) << rig.error().message();
  const Eigen::Vector3d place(0.4, 0.002, 0.003);
  EXPECT_NEAR(rig->baseline, place.norm(), 1e-9);
  // A point is followed by hand from the old rectified axes to the raw ones, and by the new R on.
  const Eigen::Vector3d point(0.3, 0.5, 4), raw_left = pair.left.R.transpose() * point,
                                            raw_right = pair.right.R.transpose() * (point - place);
  const Eigen::Matrix3d K = made.left.P.leftCols<3>();
  const Eigen::Vector2d left = (K * made.left.R * raw_left).hnormalized(),
                        right = (K * made.right.R * raw_right).hnormalized();
  EXPECT_NEAR(left.y(), right.y(), 1e-6);
  EXPECT_NEAR(left.x() - right.x(), rig->fb() / (made.left.R * raw_left).z(), 1e-6);
}

TEST(WorkingPair, RefusesABaselineThatPointsElsewhere) {
  Pair pair;
  pair.right.P(1, 3) = -250 * 0.012;  // 3 % of the baseline
  const Expected<CameraPair> made = workingPair(pair.left, pair.right, {});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().detail, "right P[7]: -3, expected 0 as on the left: the same row in both images");
}

TEST(WorkingPair, OfARigUpsideDownSeesTheSameWorldTheOtherWayUp) {
  const Pair pair;
  const CameraPair made = working(pair, true);
  const Expected<StereoRig> rig = makeStereoRig(made.left, made.right);
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_NEAR(rig->baseline, 0.4, 1e-12);
  EXPECT_EQ(made.left.K, pair.right.K) << "the other camera, as it is";
  EXPECT_EQ(made.left.D, pair.right.D);
  // A point in the given left camera's rectified axes, and in the new left one's: that stands 0.4 m to the
  // right, and its axes are turned by half a turn about z.
  const Eigen::Vector3d point(0.3, -0.5, 4), turned(-(0.3 - 0.4), 0.5, 4);
  const Eigen::Vector2d before_left = pixel(pair.left, point), before_right = pixel(pair.right, point);
  const Eigen::Vector2d after_left = pixel(made.left, turned), after_right = pixel(made.right, turned);
  EXPECT_TRUE(after_left.isApprox(Eigen::Vector2d(319, 239) - before_right, 1e-12)) << after_left;
  EXPECT_TRUE(after_right.isApprox(Eigen::Vector2d(319, 239) - before_left, 1e-12)) << after_right;
}

/// The rectified picture of a rig upside down is the rectified picture turned by 180 degrees.
void expectTurnedPicture(const Pair& pair) {
  const CameraPair made = working(pair, true);
  const Expected<Rectifier> before = Rectifier::create(pair.right), after = Rectifier::create(made.left);
  ASSERT_TRUE(before && after);
  cv::Mat raw(pair.right.imageSize(), CV_8UC1), upright, given, turned, mask;
  cv::randu(raw, 0, 256);
  ASSERT_FALSE(before->rectify(raw, given));
  ASSERT_FALSE(after->rectify(raw, upright));
  cv::flip(given, turned, -1);
  cv::flip(before->mask(), mask, -1);
  EXPECT_EQ(cv::countNonZero(mask != after->mask()), 0);
  // Places in the raw picture are rounded to 1/32 px, from the other side.
  cv::Mat difference;
  cv::absdiff(turned, upright, difference);
  EXPECT_LT(cv::mean(difference)[0], 2);
}

TEST(WorkingPair, OfARigUpsideDownHasTurnedPictures) { expectTurnedPicture({}); }

TEST(WorkingPair, OfARigUpsideDownHasTurnedPicturesWithBinningAndRegion) {
  Pair pair;
  for (CameraCalibration* c : {&pair.left, &pair.right}) {
    c->roi = {40, 20, 240, 180};
    c->binning_x = c->binning_y = 2;
  }
  expectTurnedPicture(pair);
}

TEST(WorkingPair, NamesTheCamerasAsTheyWereGiven) {
  Pair pair;
  pair.right.K(0, 0) = 0;
  RigParameters parameters;
  parameters.upside_down = true;
  const Expected<CameraPair> made = workingPair(pair.left, pair.right, parameters);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().detail, "right K[0]: 0, expected a positive focal length in pixels");
}

}  // namespace
}  // namespace uav_landing
