#include "uav_landing/geometry/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace uav_landing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

CameraCalibration camera(double Tx) {
  CameraCalibration c;
  c.width = 640;
  c.height = 480;
  c.distortion_model = "plumb_bob";
  c.D = {-0.2, 0.05, 0.001, -0.001, 0};
  c.K << 510, 0, 318, 0, 512, 243, 0, 0, 1;
  c.R = Eigen::Matrix3d::Identity();
  c.P << 500, 0, 320, Tx, 0, 500, 240, 0, 0, 0, 1, 0;
  return c;
}

struct Pair {
  CameraCalibration left = camera(0), right = camera(-250);
};

std::string complaint(const Pair& pair) {
  const Expected<StereoRig> rig = makeStereoRig(pair.left, pair.right);
  return rig ? "" : rig.error().message();
}

TEST(StereoRig, TakesFocalLengthPrincipalPointsAndBaselineFromP) {
  Pair pair;
  pair.right.P(0, 2) = 330;
  const Expected<StereoRig> rig = makeStereoRig(pair.left, pair.right);
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->size, cv::Size(640, 480));
  EXPECT_EQ(rig->fx, 500);
  EXPECT_EQ(rig->fy, 500);
  EXPECT_EQ(rig->cx, 320);
  EXPECT_EQ(rig->cy, 240);
  EXPECT_EQ(rig->cx_right, 330);
  EXPECT_DOUBLE_EQ(rig->baseline, 0.5);
  EXPECT_TRUE((rig->K() * rig->Kinv()).isIdentity(1e-15));
}

TEST(StereoRig, IsInPixelsOfTheDeliveredImageWithBinningAndRoi) {
  Pair pair;
  for (CameraCalibration* c : {&pair.left, &pair.right}) {
    c->binning_x = 2;
    c->binning_y = 4;
    c->roi = {100, 80, 400, 320};
  }
  const Expected<StereoRig> rig = makeStereoRig(pair.left, pair.right);
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->size, cv::Size(200, 80));
  // A full-resolution rectified pixel (u, v) is delivered as ((u - 100) / 2, (v - 80) / 4).
  const Eigen::Vector3d X(0.3, -0.2, 2);
  const Eigen::Vector2d full(500 * 0.3 / 2 + 320, 500 * -0.2 / 2 + 240);
  EXPECT_TRUE(rig->project(X).isApprox(Eigen::Vector2d((full.x() - 100) / 2, (full.y() - 80) / 4), 1e-14));
  EXPECT_DOUBLE_EQ(rig->baseline, 0.5);
}

TEST(StereoRig, AllowsColumnOffsetsOfTheRegionsToDiffer) {
  Pair pair;
  pair.left.roi = {100, 80, 400, 320};
  pair.right.roi = {60, 80, 400, 320};
  const Expected<StereoRig> rig = makeStereoRig(pair.left, pair.right);
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->principalOffset(), -40);
}

TEST(Calibration, AcceptsTheDistortionModelsWithTheirLengths) {
  CameraCalibration c = camera(0);
  for (const size_t n : {0, 4, 5}) {
    c.D.assign(n, 0.01);
    EXPECT_FALSE(checkCalibration(c)) << n << ": " << checkCalibration(c).message();
  }
  c.distortion_model = "rational_polynomial";
  for (const size_t n : {0, 8, 12, 14}) {
    c.D.assign(n, 0.01);
    EXPECT_FALSE(checkCalibration(c)) << n << ": " << checkCalibration(c).message();
  }
  for (const char* fisheye : {"equidistant", "fisheye"}) {
    c.distortion_model = fisheye;
    c.D.assign(4, 0.01);
    EXPECT_FALSE(checkCalibration(c)) << checkCalibration(c).message();
  }
}

TEST(Calibration, AcceptsALensWithoutDistortionByAnyName) {
  CameraCalibration c = camera(0);
  for (const char* model : {"", "none", "Inverse Brown Conrady", "equidistant", "plumb_bob"})
    for (const size_t n : {0, 3, 5, 14}) {
      c.distortion_model = model;
      c.D.assign(n, 0.0);
      EXPECT_FALSE(checkCalibration(c)) << model << " " << n << ": " << checkCalibration(c).message();
    }
}

TEST(StereoRig, TakesTheBaselineFromTheDifferenceWhereAThirdCameraIsTheOrigin) {
  Pair pair;
  pair.left.P(0, 3) = 45;
  pair.right.P(0, 3) = -205;
  const Expected<StereoRig> rig = makeStereoRig(pair.left, pair.right);
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_DOUBLE_EQ(rig->baseline, 0.5);
}

TEST(StereoRig, TakesTheDistanceFromTheOriginsPlaneOutOfTheBaseline) {
  // Both cameras 0.02 m before the origin: P = K [I | t] with t = (0.06, 0, 0.02) and (-0.44, 0, 0.02).
  Pair pair;
  pair.left.P.col(3) << 500 * 0.06 + 320 * 0.02, 240 * 0.02, 0.02;
  pair.right.P.col(3) << 500 * -0.44 + 320 * 0.02, 240 * 0.02, 0.02;
  for (const bool cut : {false, true}) {
    if (cut) pair.left.roi = pair.right.roi = {100, 80, 400, 320};
    const Expected<StereoRig> rig = makeStereoRig(pair.left, pair.right);
    ASSERT_TRUE(rig) << rig.error().message();
    EXPECT_NEAR(rig->baseline, 0.5, 1e-12);
  }
}

TEST(Calibration, KnowsWhenItHasChanged) {
  CameraCalibration c = camera(0);
  EXPECT_EQ(c, camera(0));
  c.D[2] += 1e-9;
  EXPECT_NE(c, camera(0));
}

struct BadField {
  const char* name;
  std::function<void(Pair&)> damage;
  const char* message;
};

class BadCalibration : public testing::TestWithParam<BadField> {};

TEST_P(BadCalibration, IsRefusedWithTheFieldsName) {
  Pair pair;
  GetParam().damage(pair);
  EXPECT_EQ(complaint(pair), std::string("input_invalid: ") + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Fields, BadCalibration,
    testing::Values(
        BadField{"width_zero", [](Pair& p) { p.left.width = 0; },
                 "left width: 0, expected 1 to 16384 pixels"},
        BadField{"height_negative", [](Pair& p) { p.right.height = -480; },
                 "right height: -480, expected 1 to 16384 pixels"},
        BadField{"height_huge", [](Pair& p) { p.left.height = 1 << 30; },
                 "left height: 1073741824, expected 1 to 16384 pixels"},
        BadField{"everything_zero", [](Pair& p) { p.left = CameraCalibration(); },
                 "left width: 0, expected 1 to 16384 pixels"},
        BadField{"K_zero", [](Pair& p) { p.left.K.setZero(); },
                 "left K[0]: 0, expected a positive focal length in pixels"},
        BadField{"K_fy_negative", [](Pair& p) { p.right.K(1, 1) = -1; },
                 "right K[4]: -1, expected a positive focal length in pixels"},
        BadField{"K_cx_zero", [](Pair& p) { p.left.K(0, 2) = 0; },
                 "left K[2]: 0, expected the column of the principal point in pixels"},
        BadField{"K_cy_nan", [](Pair& p) { p.left.K(1, 2) = kNan; }, "left K[5]: nan, expected a number"},
        BadField{"K_skew", [](Pair& p) { p.left.K(0, 1) = 0.5; }, "left K[1]: 0.5, expected 0"},
        BadField{"K_scale", [](Pair& p) { p.left.K(2, 2) = 2; }, "left K[8]: 2, expected 1"},
        BadField{"P_fx_zero", [](Pair& p) { p.left.P(0, 0) = 0; },
                 "left P[0]: 0, expected a positive focal length in pixels"},
        BadField{"P_fy_nan", [](Pair& p) { p.right.P(1, 1) = kNan; }, "right P[5]: nan, expected a number"},
        BadField{"P_cy_zero", [](Pair& p) { p.right.P(1, 2) = 0; },
                 "right P[6]: 0, expected the row of the principal point in pixels"},
        BadField{"P_Tx_infinite", [](Pair& p) { p.right.P(0, 3) = -INFINITY; },
                 "right P[3]: -inf, expected a number"},
        BadField{"P_scale", [](Pair& p) { p.right.P(2, 2) = 0; }, "right P[10]: 0, expected 1"},
        BadField{"R_zero", [](Pair& p) { p.left.R.setZero(); },
                 "left R: all zero, expected a rotation matrix"},
        BadField{"R_nan", [](Pair& p) { p.left.R(1, 2) = kNan; }, "left R[5]: nan, expected a number"},
        BadField{"R_scaled", [](Pair& p) { p.right.R *= 2; },
                 "right R: R R' differs from the identity by 3, expected a rotation matrix"},
        BadField{"R_reflection", [](Pair& p) { p.right.R(0, 0) = -1; },
                 "right R: a reflection, expected a rotation matrix"},
        BadField{"D_nan", [](Pair& p) { p.left.D[2] = kNan; }, "left D[2]: nan, expected a number"},
        BadField{"D_length", [](Pair& p) { p.left.D.resize(3); },
                 "left D: 3 coefficients, expected 4 or 5 for plumb_bob"},
        BadField{"D_rational_length", [](Pair& p) { p.left.distortion_model = "rational_polynomial"; },
                 "left D: 5 coefficients, expected 8, 12 or 14 for rational_polynomial"},
        BadField{"model", [](Pair& p) { p.right.distortion_model = "equidistant"; },
                 "right D: 5 coefficients, expected 4 for equidistant"},
        BadField{"model_missing", [](Pair& p) { p.right.distortion_model = ""; },
                 "right distortion_model: \"\", expected plumb_bob, rational_polynomial or equidistant "
                 "(fisheye lenses)"},
        BadField{"binning", [](Pair& p) { p.left.binning_x = -2; }, "left binning_x: -2, expected 0 or more"},
        BadField{"binning_large", [](Pair& p) { p.left.binning_y = 500; },
                 "left binning_y: 500, expected at most the height of the image"},
        BadField{"roi_outside",
                 [](Pair& p) {
                   p.left.roi = {600, 0, 100, 480};
                 },
                 "left roi.width: 100, expected 1 to 40 pixels"},
        BadField{"roi_overflow",
                 [](Pair& p) {
                   p.left.roi = {600, 0, std::numeric_limits<int>::max(), 480};
                 },
                 "left roi.width: 2147483647, expected 1 to 40 pixels"},
        BadField{"roi_empty",
                 [](Pair& p) {
                   p.right.roi = {10, 10, 100, 0};
                 },
                 "right roi.height: 0, expected 1 to 470 pixels"},
        BadField{"roi_negative",
                 [](Pair& p) {
                   p.right.roi = {10, -1, 100, 100};
                 },
                 "right roi.y_offset: -1, expected a row of the image"},
        BadField{"widths_differ", [](Pair& p) { p.right.width = 641; },
                 "right width: 641, expected 640 as on the left"},
        BadField{"binning_differs", [](Pair& p) { p.right.binning_x = 2; },
                 "right binning_x: 2, expected 1 as on the left"},
        BadField{"roi_rows_differ",
                 [](Pair& p) {
                   p.left.roi = {0, 10, 640, 400};
                   p.right.roi = {0, 12, 640, 400};
                 },
                 "right roi.y_offset: 12, expected 10 as on the left"},
        BadField{"focal_lengths_differ", [](Pair& p) { p.right.P(0, 0) = 501; },
                 "right P[0]: 501, expected 500 as on the left"},
        BadField{"vertical_focal_lengths_differ", [](Pair& p) { p.right.P(1, 1) = 499; },
                 "right P[5]: 499, expected 500 as on the left"},
        BadField{"rows_differ", [](Pair& p) { p.right.P(1, 2) = 241.5; },
                 "right P[6]: 241.5, expected 240 as on the left"},
        BadField{
            "baseline_zero", [](Pair& p) { p.right.P(0, 3) = 0; },
            "right P[3]: 0, expected -P[0] times the baseline in metres, a negative number: these are two "
            "single calibrations, not one of the pair"},
        BadField{"one_place", [](Pair& p) { p.left.P(0, 3) = -250; },
                 "left P[3]: -250, expected 0: it is that of the right camera, too, as if both stood in one "
                 "place"},
        BadField{"exchanged",
                 [](Pair& p) {
                   p.left.P(0, 3) = -250;
                   p.right.P(0, 3) = 0;
                 },
                 "left P[3]: -250, expected 0, and a negative right P[3], which is 0: left and right are "
                 "exchanged"},
        BadField{"baseline_negative", [](Pair& p) { p.right.P(0, 3) = 250; },
                 "right P[3]: 250, expected -P[0] times the baseline in metres, a negative number: left and "
                 "right are exchanged, or the driver's sign is wrong"},
        BadField{"one_above_the_other",
                 [](Pair& p) {
                   p.right.P(0, 3) = 0;
                   p.right.P(1, 3) = -250;
                 },
                 "right P[7]: -250, expected 0: the right camera stands below the left one, and the pair has "
                 "to stand side by side"},
        BadField{"one_before_the_other", [](Pair& p) { p.right.P.col(3) << -250 - 32, -24, -0.1; },
                 "right P[11]: -0.1, expected 0 as on the left"},
        BadField{"baseline_tilted", [](Pair& p) { p.right.P(1, 3) = 5; },
                 "right P[7]: 5, expected 0 as on the left: the same row in both images"}),
    [](const testing::TestParamInfo<BadField>& info) { return info.param.name; });

}  // namespace
}  // namespace uav_landing
