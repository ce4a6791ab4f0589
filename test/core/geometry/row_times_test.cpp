#include "uav_landing/geometry/row_times.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "support/rolling_camera.h"
#include "uav_landing/geometry/camera_pair.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {
namespace {

constexpr double kReadout = 0.03;  // s

CameraCalibration plainCamera() { return test::calibrationOf(test::makeRig(640, 480, 1)); }

TEST(RowTimes, OfAGlobalShutterAndOfNothingGivenAreTheStamp) {
  EXPECT_TRUE(RowTimes().atOnce());
  EXPECT_EQ(RowTimes().at(3, 400), 0);
  EXPECT_TRUE(RowTimes(plainCamera(), leftReadout(RigParameters())).atOnce());
  EXPECT_TRUE(RowTimes(plainCamera(), rightReadout(RigParameters())).atOnce());
  RigParameters global;
  global.readout_time = 0;
  EXPECT_TRUE(RowTimes(plainCamera(), leftReadout(global)).atOnce());
}

TEST(RowTimes, RunFromTheFirstRowToTheLastAroundTheOneOfTheStamp) {
  const RowTimes times(plainCamera(), {kReadout, 0.5});
  for (const double u : {0.0, 300.7, 639.0})
    for (const double v : {0.0, 17.3, 239.5, 479.0})
      EXPECT_NEAR(times.at(u, v), ((v + 0.5) / 480 - 0.5) * kReadout, 1e-9) << u << ' ' << v;
  EXPECT_NEAR(RowTimes(plainCamera(), {kReadout, 0}).at(9, 479), 479.5 / 480 * kReadout, 1e-9);
  EXPECT_NEAR(RowTimes(plainCamera(), {kReadout, 1}).at(9, 479), -0.5 / 480 * kReadout, 1e-9);
  EXPECT_NEAR(RowTimes(plainCamera(), {-kReadout, 0.5}).at(9, 0), 239.5 / 480 * kReadout, 1e-9);
  EXPECT_NEAR(times.plane()[0] + times.plane()[2] * 100, times.at(50, 100), 1e-9);
  EXPECT_NEAR(times.plane()[1], 0, 1e-12);
}

TEST(RowSpan, IsThatOfTheLeftCamerasRows) {
  RigParameters rig;
  EXPECT_TRUE(leftRowSpan(rig).atOnce()) << "nothing is given";
  rig.readout_time = 0.03;
  rig.stamp_row = 0.25;
  EXPECT_NEAR(leftRowSpan(rig).first, -0.0075, 1e-12);
  EXPECT_NEAR(leftRowSpan(rig).last, 0.0225, 1e-12);
  rig.readout_time = -0.03;
  EXPECT_NEAR(leftRowSpan(rig).first, -0.0225, 1e-12);
  EXPECT_NEAR(leftRowSpan(rig).last, 0.0075, 1e-12);
  rig.right_readout_time = 0.01;
  rig.upside_down = true;
  EXPECT_NEAR(leftRowSpan(rig).last, 0.0075, 1e-12) << "the camera that works as the left one";
  rig.readout_time = 0;
  rig.right_readout_time = 0;
  EXPECT_TRUE(leftRowSpan(rig).atOnce());
}

TEST(LaterRows, AreThoseOfTheMiddleUntilATenthOfTheLongerReadoutLiesBetweenOthers) {
  const RowTimes longer(plainCamera(), {kReadout, 0.5});
  const cv::Size size(640, 480);
  // The first and the last row differ by half of the difference of both readout times.
  const auto apart = [&](double shorter, bool exchanged) {
    const RowTimes other(plainCamera(), {shorter, 0.5});
    return std::abs(exchanged ? laterRows(other, longer, size) : laterRows(longer, other, size));
  };
  for (const bool exchanged : {false, true}) {
    EXPECT_LT(apart(0.82 * kReadout, exchanged), 1e-4) << "nothing in the middle row";
    EXPECT_NEAR(apart(0.78 * kReadout, exchanged), 0.11 * kReadout, 0.01 * kReadout);
  }
}

TEST(RowTimes, RunAlongTheColumnsOfAPortraitCamera) {
  const RowTimes times(plainCamera(), {kReadout, 0.5, RowDirection::kColumns});
  for (const double u : {0.0, 300.7, 639.0})
    EXPECT_NEAR(times.at(u, 77), ((u + 0.5) / 640 - 0.5) * kReadout, 1e-9);
}

// The raw row of a rectified pixel by the lens model written out.
TEST(RowTimes, AreThoseOfTheRawRowBehindLensAndRectification) {
  CameraCalibration c = plainCamera();
  c.D = {-0.2, 0.05, 0.001, -0.0005, 0};
  c.R = Eigen::AngleAxisd(0.03, Eigen::Vector3d(0.3, 0.2, 1).normalized()).toRotationMatrix();
  const RowTimes times(c, {kReadout, 0.5});
  const Eigen::Matrix3d from_pixel = (c.P.leftCols<3>() * c.R).inverse();
  for (const double u : {40.0, 333.0, 600.0})
    for (const double v : {30.0, 250.0, 455.0}) {
      const Eigen::Vector2d p = (from_pixel * Eigen::Vector3d(u, v, 1)).hnormalized();
      const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
      const double distorted =
          y * (1 + r2 * (c.D[0] + r2 * c.D[1])) + c.D[2] * (r2 + 2 * y * y) + 2 * c.D[3] * x * y;
      const double row = c.K(1, 1) * distorted + c.K(1, 2);
      EXPECT_GT(std::abs(row - v), 1) << "the lens must matter";
      EXPECT_NEAR(times.at(u, v), ((row + 0.5) / 480 - 0.5) * kReadout, 2e-3 * kReadout) << u << ' ' << v;
    }
}

// A coefficient list of another length is no lens either while it holds zeros.
TEST(RowTimes, TakeALensOfZerosForNone) {
  CameraCalibration c = plainCamera();
  c.D = {0, 0, 0};
  EXPECT_NEAR(RowTimes(c, {kReadout, 0.5}).at(100, 0), (0.5 / 480 - 0.5) * kReadout, 1e-9);
}

TEST(RowTimes, AreThoseOfThePictureThatTheDriverDelivers) {
  CameraCalibration c = plainCamera();
  c.roi = cv::Rect(0, 120, 640, 240);
  c.binning_x = c.binning_y = 2;
  const RowTimes times(c, {kReadout, 0.5});
  for (const double v : {0.0, 60.0, 119.0})
    EXPECT_NEAR(times.at(10, v), ((v + 0.5) / 120 - 0.5) * kReadout, 1e-9);
}

TEST(RowTimes, OfTheRightCameraAreTheLeftOnesUnlessGiven) {
  RigParameters parameters;
  parameters.readout_time = kReadout;
  parameters.stamp_row = 0;
  EXPECT_EQ(rightReadout(parameters).time, kReadout);
  EXPECT_EQ(rightReadout(parameters).stamp_row, 0);
  parameters.right_readout_time = 0.01;
  parameters.right_stamp_row = 1;
  EXPECT_EQ(leftReadout(parameters).time, kReadout);
  EXPECT_EQ(rightReadout(parameters).time, 0.01);
  EXPECT_EQ(rightReadout(parameters).stamp_row, 1);
}

// The raw row by the angle of the ray off the axis (cv::fisheye's model) written out.
TEST(RowTimes, AreThoseOfTheRawRowBehindAFisheyeLens) {
  CameraCalibration c = plainCamera();
  c.distortion_model = "equidistant";
  c.D = {-0.05, 0.01, -0.002, 0.001};
  const RowTimes times(c, {kReadout, 0.5});
  const Eigen::Matrix3d from_pixel = c.P.leftCols<3>().inverse();
  for (const double u : {40.0, 333.0, 600.0})
    for (const double v : {30.0, 250.0, 455.0}) {
      const Eigen::Vector2d p = (from_pixel * Eigen::Vector3d(u, v, 1)).hnormalized();
      const double angle = std::atan(p.norm()), a2 = angle * angle;
      const double distorted = angle * (1 + a2 * (c.D[0] + a2 * (c.D[1] + a2 * (c.D[2] + a2 * c.D[3]))));
      const double row = c.K(1, 1) * p.y() / p.norm() * distorted + c.K(1, 2);
      EXPECT_NEAR(times.at(u, v), ((row + 0.5) / 480 - 0.5) * kReadout, 2e-3 * kReadout) << u << ' ' << v;
    }
}

// The camera named right takes the left one's place; its first row, in the raw picture as it comes, is then
// the last one of the rectified picture.
TEST(RowTimes, OfARigUpsideDownFollowTheCamerasAndRunUpwards) {
  RigParameters parameters;
  parameters.upside_down = true;
  parameters.readout_time = kReadout;
  parameters.right_readout_time = 0.01;
  parameters.right_stamp_row = 0;
  CameraCalibration left = plainCamera(), right = left;
  right.P(0, 3) = -left.P(0, 0);  // 1 m
  const Expected<CameraPair> pair = workingPair(left, right, parameters);
  ASSERT_TRUE(pair) << pair.error().message();
  const Expected<RigModel> model = makeRigModel(pair->left, pair->right, {}, parameters);
  ASSERT_TRUE(model) << model.error().message();
  for (const double u : {3.0, 600.0})
    for (const double v : {0.0, 100.0, 479.0}) {
      const double share = (479 - v + 0.5) / 480;
      EXPECT_NEAR(model->left_times.at(u, v), share * 0.01, 1e-9) << v;
      EXPECT_NEAR(model->right_times.at(u, v), (share - 0.5) * kReadout, 1e-9) << v;
    }
  parameters.row_direction = RowDirection::kColumns;
  const Expected<RigModel> columns = makeRigModel(pair->left, pair->right, {}, parameters);
  ASSERT_TRUE(columns) << columns.error().message();
  EXPECT_NEAR(columns->left_times.at(100, 7), (539 + 0.5) / 640 * 0.01, 1e-9);
}

// Not given, the right camera's are the left one's, whichever takes the other's place.
TEST(RowTimes, OfARigUpsideDownAreAlikeUnlessGiven) {
  RigParameters parameters;
  parameters.upside_down = true;
  parameters.readout_time = kReadout;
  parameters.stamp_row = 0;
  EXPECT_EQ(leftReadout(parameters).time, kReadout);
  EXPECT_EQ(leftReadout(parameters).stamp_row, 0);
  EXPECT_EQ(rightReadout(parameters).time, kReadout);
}

Failure after(double readout, const std::vector<double>& stamps) {
  ReadoutCheck check(RowTimes(plainCamera(), {readout, 0.5}), RowTimes());
  Failure failure;
  for (const double stamp : stamps) failure = check.follow(stamp);
  return failure;
}

TEST(ReadoutCheck, RefusesRowsThatTakeLongerThanTheTimeBetweenPictures) {
  const std::vector<double> even{0, 0.05, 0.1, 0.15, 0.2, 0.25};
  EXPECT_FALSE(after(0.05, even));
  EXPECT_FALSE(after(0, even));
  for (const double readout : {0.06, -0.06}) {
    const Failure failure = after(readout, even);
    EXPECT_EQ(failure.reason, Reason::kInputInvalid);
    EXPECT_EQ(
        failure.detail,
        "rig/readout_time: 0.06 s is longer than the 0.05 s between images, expected at most that; give "
        "it in seconds, as in docs/calibration.md");
  }
  EXPECT_FALSE(after(0.04, {0, 0.05, 0.1, 0.12, 0.2, 0.25})) << "one stamp that jitters";
  EXPECT_FALSE(after(0.06, {0, 0.05})) << "too few to tell";
  std::vector<double> jittering;
  for (int i = 0; i < 60; ++i) jittering.push_back(i / 30.0 + 0.003 * ((7 * i) % 5 - 2) / 2);
  for (size_t n = 5; n <= jittering.size(); ++n)
    EXPECT_FALSE(after(0.033, {jittering.begin(), jittering.begin() + static_cast<std::ptrdiff_t>(n)})) << n;
  EXPECT_FALSE(after(0.06, {0, 0.05, 0.1, 0.15, 0.2, 0})) << "a bag that begins anew";
}

}  // namespace
}  // namespace uav_landing
