#include "uav_landing/simulator/camera_rig.h"

#include <gtest/gtest.h>

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

TEST(CameraRig, EveryPixelsRayPassesThroughItsPixel) {
  const SimulatorParameters parameters = realisticRig();
  const CameraRig rig = makeCameraRig(parameters).value();
  for (int v = 0; v < 240; v += 7) {
    for (int u = 0; u < 320; u += 7) {
      const PixelRay& ray = rig.left.rays[v * 320 + u];
      // A pixel one third to the right and one quarter down of this one's centre, too.
      for (const auto& [du, dv] : {std::pair(0.0, 0.0), std::pair(0.33, 0.25)}) {
        const Eigen::Vector3d rectified(ray.x + du * ray.xu + dv * ray.xv, ray.y + du * ray.yu + dv * ray.yv,
                                        1);
        const Eigen::Vector2d pixel =
            throughLens(parameters.left_camera, rig.left.calibration.R.transpose() * rectified);
        ASSERT_NEAR(pixel.x(), u + du, 0.002) << u << ", " << v;
        ASSERT_NEAR(pixel.y(), v + dv, 0.002) << u << ", " << v;
      }
    }
  }
}

TEST(CameraRig, RectifiedCamerasShareAxesAndStandABaselineApart) {
  const SimulatorParameters parameters = realisticRig();
  const CameraRig rig = makeCameraRig(parameters).value();
  EXPECT_NEAR(rig.right.offset_x, std::sqrt(0.65 * 0.65 + 0.004 * 0.004 + 0.006 * 0.006), 1e-9);
  const Eigen::Vector3d point(0.7, -0.4, 5);  // rectified left axes
  const Eigen::Vector3d raw_left = rig.left.calibration.R.transpose() * point;
  const Eigen::Vector3d raw_right = leftToRight(parameters.rig, raw_left);
  const Eigen::Vector3d rectified_right = rig.right.calibration.R * raw_right;
  EXPECT_TRUE(rectified_right.isApprox(point - Eigen::Vector3d(rig.right.offset_x, 0, 0), 1e-9))
      << rectified_right;
}

TEST(CameraRig, CalibrationMakesARigForTheChain) {
  const CameraRig rig = makeCameraRig(realisticRig()).value();
  const Expected<StereoRig> stereo = makeStereoRig(rig.left.calibration, rig.right.calibration);
  ASSERT_TRUE(stereo) << stereo.error().message();
  EXPECT_NEAR(stereo->baseline, rig.right.offset_x, 1e-9);
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
