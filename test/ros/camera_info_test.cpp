#include "camera_info.h"

#include <gtest/gtest.h>

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

TEST(CameraInfo, TheRegionOfInterestAndBinningGiveTheImageSize) {
  EXPECT_EQ(toCalibration(distinctInfo()).imageSize(), cv::Size(160, 60));
}

TEST(CameraInfo, ComesBackUnchanged) {
  const sensor_msgs::CameraInfo info = distinctInfo();
  EXPECT_EQ(toCameraInfo(toCalibration(info), info.header), info);
}

}  // namespace
