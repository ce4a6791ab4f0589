#include "camera_info.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

using namespace uav_landing;

namespace {

sensor_msgs::CameraInfo distinctInfo() {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.D = {1, 2, 3, 4, 5};
  for (size_t i = 0; i < 9; ++i) info.K[i] = 10.0 + static_cast<double>(i);
  for (size_t i = 0; i < 9; ++i) info.R[i] = 20.0 + static_cast<double>(i);
  for (size_t i = 0; i < 12; ++i) info.P[i] = 30.0 + static_cast<double>(i);
  info.binning_x = 2;
  info.binning_y = 4;
  info.roi.x_offset = 16;
  info.roi.y_offset = 8;
  info.roi.width = 320;
  info.roi.height = 240;
  return info;
}

TEST(CameraInfo, KeepsRowsAndColumnsOfTheMatrices) {
  const CameraCalibration calibration = toCalibration(distinctInfo());
  EXPECT_EQ(calibration.K(0, 2), 12);
  EXPECT_EQ(calibration.K(2, 0), 16);
  EXPECT_EQ(calibration.R(1, 2), 25);
  EXPECT_EQ(calibration.P(0, 3), 33);
  EXPECT_EQ(calibration.P(2, 3), 41);
}

TEST(CameraInfo, EachNumberGoesToItsOwnPlace) {
  const CameraCalibration calibration = toCalibration(distinctInfo());
  EXPECT_EQ(calibration.width, 640);
  EXPECT_EQ(calibration.height, 480);
  EXPECT_EQ(calibration.distortion_model, "plumb_bob");
  EXPECT_EQ(calibration.D, (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(calibration.binning_x, 2);
  EXPECT_EQ(calibration.binning_y, 4);
  EXPECT_EQ(calibration.roi, cv::Rect(16, 8, 320, 240));
}

TEST(CameraInfo, EachNumberMakesAnotherCamera) {
  // The chain starts anew when one of them changes.
  const CameraCalibration before = toCalibration(distinctInfo());
  EXPECT_TRUE(toCalibration(distinctInfo()) == before);
  const std::vector<std::function<void(sensor_msgs::CameraInfo&)>> changes{
      [](auto& info) { info.width = 641; },
      [](auto& info) { info.height = 481; },
      [](auto& info) { info.distortion_model = ""; },
      [](auto& info) { info.D[4] += 1; },
      [](auto& info) { info.K[4] += 1; },
      [](auto& info) { info.R[8] += 1; },
      [](auto& info) { info.P[3] += 1; },
      [](auto& info) { info.binning_x = 1; },
      [](auto& info) { info.binning_y = 1; },
      [](auto& info) { info.roi.x_offset = 15; },
      [](auto& info) { info.roi.y_offset = 7; },
      [](auto& info) { info.roi.width = 319; },
      [](auto& info) { info.roi.height = 239; }};
  for (size_t i = 0; i < changes.size(); ++i) {
    sensor_msgs::CameraInfo info = distinctInfo();
    changes[i](info);
    EXPECT_FALSE(toCalibration(info) == before) << i;
  }
}

TEST(CameraInfo, TheRegionOfInterestAndBinningGiveTheImageSize) {
  EXPECT_EQ(toCalibration(distinctInfo()).imageSize(), cv::Size(160, 60));
}

TEST(CameraInfo, ComesBackUnchanged) {
  const sensor_msgs::CameraInfo info = distinctInfo();
  EXPECT_EQ(toCameraInfo(toCalibration(info), info.header), info);
}

}  // namespace
