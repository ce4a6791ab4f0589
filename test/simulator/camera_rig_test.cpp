#include "uav_landing/simulator/camera_rig.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <utility>

#include "simulator/lens.h"

namespace uav_landing {
namespace {

SimulatorParameters realisticRig() {
  SimulatorParameters parameters;
  parameters.image.width = 320;
  parameters.image.height = 240;
  makeRealistic(parameters.left_camera, parameters.right_camera, parameters.rig);
  return parameters;
}

/// 53 degrees to each side.
SimulatorParameters fisheyeRig() {
  SimulatorParameters parameters = realisticRig();
  for (SimulatedCameraParameters* camera : {&parameters.left_camera, &parameters.right_camera}) {
    camera->lens = SimulatedLens::kEquidistant;
    camera->fx = 172, camera->fy = 171;
    camera->k1 = -0.02, camera->k2 = 0.008, camera->k3 = -0.003, camera->k4 = 0.0005;
    camera->p1 = camera->p2 = 0;
  }
  return parameters;
}

class CameraRigOfLens : public testing::TestWithParam<SimulatorParameters> {};
INSTANTIATE_TEST_SUITE_P(Lenses, CameraRigOfLens, testing::Values(realisticRig(), fisheyeRig()),
                         [](const auto& info) {
                           return std::string(info.index == 0 ? "plumb_bob" : "fisheye");
                         });

TEST_P(CameraRigOfLens, EveryPixelsRayPassesThroughItsPixel) {
  const SimulatorParameters& parameters = GetParam();
  const CameraRig rig = makeCameraRig(parameters).value();
  // Rays are those of parallelograms, which the corners of a wide lens's picture are less.
  const double tolerance = parameters.left_camera.lens == SimulatedLens::kEquidistant ? 0.005 : 0.002;
  for (int v = 0; v < 240; v += 7) {
    for (int u = 0; u < 320; u += 7) {
      const PixelRay& ray = rig.left.rays[v * 320 + u];
      // A pixel one third to the right and one quarter down of this one's centre, too.
      for (const auto& [du, dv] : {std::pair(0.0, 0.0), std::pair(0.33, 0.25)}) {
        const Eigen::Vector3d rectified(ray.x + du * ray.xu + dv * ray.xv, ray.y + du * ray.yu + dv * ray.yv,
                                        1);
        const Eigen::Vector2d pixel =
            throughLens(parameters.left_camera, rig.left.calibration.R.transpose() * rectified);
        ASSERT_NEAR(pixel.x(), u + du, tolerance) << u << ", " << v;
        ASSERT_NEAR(pixel.y(), v + dv, tolerance) << u << ", " << v;
      }
    }
  }
}

TEST_P(CameraRigOfLens, RectifiedCamerasShareAxesAndStandABaselineApart) {
  const SimulatorParameters& parameters = GetParam();
  const CameraRig rig = makeCameraRig(parameters).value();
  EXPECT_NEAR(rig.right.offset_x, std::sqrt(0.65 * 0.65 + 0.004 * 0.004 + 0.006 * 0.006), 1e-9);
  const Eigen::Vector3d point(0.7, -0.4, 5);  // rectified left axes
  const Eigen::Vector3d raw_left = rig.left.calibration.R.transpose() * point;
  const Eigen::Vector3d raw_right = leftToRight(parameters.rig, raw_left);
  const Eigen::Vector3d rectified_right = rig.right.calibration.R * raw_right;
  EXPECT_TRUE(rectified_right.isApprox(point - Eigen::Vector3d(rig.right.offset_x, 0, 0), 1e-9))
      << rectified_right;
}

TEST_P(CameraRigOfLens, CalibrationMakesARigForTheChain) {
  const CameraRig rig = makeCameraRig(GetParam()).value();
  const Expected<StereoRig> stereo = makeStereoRig(rig.left.calibration, rig.right.calibration);
  ASSERT_TRUE(stereo) << stereo.error().message();
  EXPECT_NEAR(stereo->baseline, rig.right.offset_x, 1e-9);
}

TEST(CameraRig, RightCameraTurnsWithoutTheCalibrationKnowing) {
  SimulatorParameters straight = realisticRig(), bent = straight;
  bent.rig.bend_rx_deg = 0.2, bent.rig.bend_ry_deg = -0.3, bent.rig.bend_rz_deg = 0.25;
  const CameraRig before = makeCameraRig(straight).value(), after = makeCameraRig(bent).value();
  EXPECT_TRUE(after.right.calibration == before.right.calibration);
  EXPECT_EQ(after.left.rays[100].x, before.left.rays[100].x);
  // By hand, first order in the angles: the camera's pixel (x, y) looks along r + w x r afterwards.
  const double wx = 0.2 * kDegree, wy = -0.3 * kDegree, wz = 0.25 * kDegree;
  for (int i = 0; i < 320 * 240; i += 997) {
    const PixelRay& was = before.right.rays[i];
    const PixelRay& is = after.right.rays[i];
    const double x = was.x, y = was.y;
    EXPECT_NEAR(is.x - x, wy * (1 + x * x) - wx * x * y - wz * y, 8e-5) << i;
    EXPECT_NEAR(is.y - y, -wx * (1 + y * y) + wy * x * y + wz * x, 8e-5) << i;
  }
}

TEST(CameraRig, RightPictureIsLowerAndInclinedWithoutTheCalibrationKnowing) {
  SimulatorParameters exact = realisticRig(), off = exact;
  off.rig.lens_rows = 0.4, off.rig.lens_tilt_deg = 0.1;
  const CameraRig before = makeCameraRig(exact).value(), after = makeCameraRig(off).value();
  EXPECT_TRUE(after.right.calibration == before.right.calibration);
  EXPECT_EQ(after.left.rays[100].y, before.left.rays[100].y);
  for (int i = 0; i < 320 * 240; i += 997) {
    const PixelRay& was = before.right.rays[i];
    const PixelRay& is = after.right.rays[i];
    EXPECT_FLOAT_EQ(is.x, was.x) << i;
    // What was seen in a pixel is now this much lower: the pixel sees what is higher.
    EXPECT_NEAR(is.y - was.y, -0.4 / exact.right_camera.fy - 0.1 * kDegree * was.x, 1e-6) << i;
  }
}

TEST(CameraRig, BaselineStretchesWithoutTheCalibrationKnowing) {
  SimulatorParameters parameters = realisticRig();
  const CameraRig before = makeCameraRig(parameters).value();
  parameters.rig.stretch = 0.02;
  const CameraRig after = makeCameraRig(parameters).value();
  EXPECT_TRUE(after.right.calibration == before.right.calibration);
  EXPECT_NEAR(after.right.offset_x, 1.02 * before.right.offset_x, 1e-12);
}

TEST(CameraRig, LensesOfTwoKindsAreRefused) {
  SimulatorParameters parameters = fisheyeRig();
  parameters.right_camera.lens = SimulatedLens::kPlumbBob;
  const Expected<CameraRig> rig = makeCameraRig(parameters);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().detail,
            "right_camera/lens: expected the lens of left_camera, as both are rectified together");
}

TEST(CameraRig, LensThatFoldsBackIsRefused) {
  SimulatorParameters parameters = realisticRig();
  parameters.right_camera.k1 = -1;
  parameters.right_camera.fx = parameters.right_camera.fy = 150;
  const Expected<CameraRig> rig = makeCameraRig(parameters);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().detail, "right_camera/k1: the lens's distortion folds back within the image");
}

class OutOfLineTest : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(OutOfLineTest, CamerasThatAreNotSideBySideAreRefused) {
  SimulatorParameters parameters = realisticRig();
  parameters.rig.x = 0.001;
  std::tie(parameters.rig.y, parameters.rig.z) = GetParam();
  const Expected<CameraRig> rig = makeCameraRig(parameters);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().detail, "rig: the cameras stand too far out of line to be rectified as a pair");
}

INSTANTIATE_TEST_SUITE_P(CameraRig, OutOfLineTest,
                         testing::Values(std::pair(10.0, 0.0), std::pair(0.0, 10.0)));

}  // namespace
}  // namespace uav_landing
