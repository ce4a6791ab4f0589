#include "uav_landing/image/rig_masks.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "support/bad_configurations.h"

namespace uav_landing {
namespace {

CameraCalibration cameraOf(const YAML::Node& given) {
  CameraCalibration camera;
  camera.width = 320;
  camera.height = 240;
  if (given["binning"]) camera.binning_x = camera.binning_y = given["binning"].as<int>();
  if (given["roi"]) camera.roi = cv::Rect(0, 0, 320, given["roi"].as<int>());
  return camera;
}

class RigMasksTest : public testing::Test {
 protected:
  RigMasksTest() { std::filesystem::create_directories(folder_); }
  ~RigMasksTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// A mask of 320 x 240, white on top, with what is given in a row of docs/bad_configurations.md.
  void write(const YAML::Node& given) const {
    if (given["missing"]) return;
    if (given["text"]) {
      std::ofstream(path("nose.png")) << given["text"].as<std::string>();
      return;
    }
    const cv::Size size =
        given["size"] ? cv::Size(given["size"][0].as<int>(), given["size"][1].as<int>()) : cv::Size(320, 240);
    const int depth = given["bits"] && given["bits"].as<int>() == 16 ? CV_16U : CV_8U;
    const int channels = given["channels"] ? given["channels"].as<int>() : 1;
    const double white = given["white"] ? given["white"].as<double>() : 0.75;
    cv::Mat mask(size, CV_MAKETYPE(depth, channels), cv::Scalar::all(0));
    mask.rowRange(0, cvRound(white * size.height)) = cv::Scalar::all(255);
    ASSERT_TRUE(cv::imwrite(path("nose.png"), mask));
  }

  /// What is wrong with it, read and for this camera. left: whose mask it is.
  Failure failureOf(const YAML::Node& given, bool left) const {
    RigParameters parameters;
    (left ? parameters.left_mask : parameters.right_mask) = path("nose.png");
    const Expected<RigMasks> masks = loadRigMasks(parameters);
    if (!masks) return masks.error();
    return checkMaskSize(left ? masks->left : masks->right, cameraOf(given));
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("rig_masks_" + std::to_string(getpid()));
};

TEST_F(RigMasksTest, RefusesWhatTheDocumentationSaysInItsWords) {
  const std::string shown = "/home/me/nose.png";
  for (const test::BadConfiguration& row : test::badConfigurations("Masks")) {
    for (const std::string side : {"left", "right"}) {
      SCOPED_TRACE(row.given + " " + side);
      const YAML::Node given = YAML::Load(row.given);
      std::filesystem::remove(path("nose.png"));
      write(given);
      std::string expected = "rig/" + side + "_mask: " + path("nose.png") + ": " + row.message;
      if (const size_t at = expected.find(shown); at != std::string::npos)
        expected.replace(at, shown.size(), path("nose.png"));
      const Failure failure = failureOf(given, side == "left");
      EXPECT_EQ(failure.reason, Reason::kInputInvalid);
      EXPECT_EQ(failure.detail, expected);
    }
  }
}

TEST_F(RigMasksTest, AFolderIsNoImage) {
  std::filesystem::create_directories(path("nose.png"));
  EXPECT_EQ(failureOf({}, true).detail,
            "rig/left_mask: " + path("nose.png") + ": is not an image that can be read, expected a PNG");
}

TEST_F(RigMasksTest, TakesWhatLeavesATenthOfThePicture) {
  write(YAML::Load("{white: 0.1}"));
  EXPECT_FALSE(failureOf({}, true));
}

TEST_F(RigMasksTest, TakesAMaskOfThePictureThatABinnedCameraDelivers) {
  const YAML::Node given = YAML::Load("{size: [160, 60], binning: 2, roi: 120}");
  write(given);
  EXPECT_FALSE(failureOf(given, true)) << failureOf(given, true).detail;
}

TEST_F(RigMasksTest, KeepsThePixelsOfEachCamera) {
  cv::Mat left(240, 320, CV_8UC1, cv::Scalar(255)), right(240, 320, CV_8UC1, cv::Scalar(1));
  left(cv::Rect(10, 200, 100, 40)) = 0;
  cv::imwrite(path("left.png"), left);
  cv::imwrite(path("right.png"), right);
  RigParameters parameters;
  parameters.left_mask = path("left.png");
  parameters.right_mask = path("right.png");
  const Expected<RigMasks> masks = loadRigMasks(parameters);
  ASSERT_TRUE(masks) << masks.error().message();
  EXPECT_EQ(cv::norm(masks->left.usable, left, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(masks->right.usable, right, cv::NORM_INF), 0);
}

TEST_F(RigMasksTest, WithoutFilesThereAreNone) {
  const Expected<RigMasks> masks = loadRigMasks({});
  ASSERT_TRUE(masks);
  EXPECT_TRUE(masks->left.usable.empty());
  EXPECT_TRUE(masks->right.usable.empty());
  EXPECT_FALSE(checkMaskSize(masks->left, cameraOf({})));
}

}  // namespace
}  // namespace uav_landing
