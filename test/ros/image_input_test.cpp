#include "image_input.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

using namespace uav_landing;

namespace {

sensor_msgs::ImagePtr makeImage(const std::string& encoding, uint32_t pixel_bytes) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->width = 4;
  image->height = 2;
  image->encoding = encoding;
  image->step = 4 * pixel_bytes;
  image->data.assign(image->step * image->height, 100);
  return image;
}

CameraCalibration announcing(int width, int height) {
  CameraCalibration calibration;
  calibration.width = width;
  calibration.height = height;
  return calibration;
}

std::string failureOf(const sensor_msgs::ImageConstPtr& image, const CameraCalibration& calibration) {
  const auto mono = toMono8(image, calibration, "/stereo/left/image_raw");
  return mono ? "" : mono.error().message();
}

TEST(ImageInput, Mono8SharesTheMessagesMemory) {
  const auto image = makeImage("mono8", 1);
  const auto mono = toMono8(image, announcing(4, 2), "left");
  ASSERT_TRUE(mono.has_value());
  EXPECT_EQ((*mono)->image.data, image->data.data());
}

TEST(ImageInput, PaddedRowsAreSkipped) {
  const auto image = makeImage("mono8", 1);
  image->step = 6;
  image->data.assign(12, 0);
  image->data[6] = 200;
  const auto mono = toMono8(image, announcing(4, 2), "left");
  ASSERT_TRUE(mono.has_value());
  EXPECT_EQ((*mono)->image.at<uint8_t>(1, 0), 200);
}

TEST(ImageInput, Mono16IsTakenAsFullRange) {
  const auto image = makeImage("mono16", 2);
  auto* pixels = reinterpret_cast<uint16_t*>(image->data.data());
  pixels[0] = 65535;
  pixels[1] = 100 * 257;
  pixels[2] = 0;
  const auto mono = toMono8(image, announcing(4, 2), "left");
  ASSERT_TRUE(mono.has_value());
  EXPECT_EQ((*mono)->image.at<uint8_t>(0, 0), 255);
  EXPECT_EQ((*mono)->image.at<uint8_t>(0, 1), 100);
  EXPECT_EQ((*mono)->image.at<uint8_t>(0, 2), 0);
}

TEST(ImageInput, BigEndianMono16IsSwapped) {
  const auto image = makeImage("mono16", 2);
  image->is_bigendian = true;
  image->data[0] = 100;  // high byte first
  image->data[1] = 100;
  image->data[2] = 200;
  image->data[3] = 0;
  const auto mono = toMono8(image, announcing(4, 2), "left");
  ASSERT_TRUE(mono.has_value());
  EXPECT_EQ((*mono)->image.at<uint8_t>(0, 0), 100);
  EXPECT_EQ((*mono)->image.at<uint8_t>(0, 1), 199) << "0xC800 / 257";
}

TEST(ImageInput, ColourBecomesLuma) {
  const auto image = makeImage("bgr8", 3);
  image->data[0] = 255;  // blue
  image->data[1] = 0;
  image->data[2] = 0;
  const auto bgr = toMono8(image, announcing(4, 2), "left");
  image->encoding = "rgb8";
  const auto rgb = toMono8(image, announcing(4, 2), "left");
  ASSERT_TRUE(bgr.has_value());
  ASSERT_TRUE(rgb.has_value());
  EXPECT_NEAR((*bgr)->image.at<uint8_t>(0, 0), 0.114 * 255, 1);
  EXPECT_NEAR((*rgb)->image.at<uint8_t>(0, 0), 0.299 * 255, 1);
}

TEST(ImageInput, EveryBayerPatternIsUnderstood) {
  for (const char* encoding : {"bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8"}) {
    const auto mono = toMono8(makeImage(encoding, 1), announcing(4, 2), "left");
    ASSERT_TRUE(mono.has_value()) << encoding;
    EXPECT_EQ((*mono)->image.type(), CV_8UC1) << encoding;
  }
}

TEST(ImageInput, AnotherSizeThanAnnouncedIsRefused) {
  EXPECT_EQ(failureOf(makeImage("mono8", 1), announcing(8, 2)),
            "input_invalid: /stereo/left/image_raw: width, height: 4x2, but camera_info announces 8x2");
}

TEST(ImageInput, AnUnknownEncodingIsRefusedWithTheKnownOnes) {
  const std::string failure = failureOf(makeImage("32FC1", 4), announcing(4, 2));
  EXPECT_NE(failure.find("/stereo/left/image_raw: encoding: \"32FC1\" is not one of mono8 mono16"),
            std::string::npos)
      << failure;
}

TEST(ImageInput, TruncatedDataIsRefused) {
  const auto image = makeImage("mono8", 1);
  image->data.resize(5);
  EXPECT_EQ(failureOf(image, announcing(4, 2)),
            "input_invalid: /stereo/left/image_raw: data: 5 bytes, but step x height is 8");
}

TEST(ImageInput, AStepShorterThanARowIsRefused) {
  const auto image = makeImage("bgr8", 3);
  image->step = 4;
  image->data.resize(8);
  EXPECT_NE(failureOf(image, announcing(4, 2)).find("step: 4 bytes are fewer than a row"), std::string::npos);
}

TEST(ImageInput, NoCalibrationSizeIsRefusedWithoutACrash) {
  EXPECT_NE(failureOf(makeImage("mono8", 1), announcing(0, 0)).find("camera_info announces 0x0"),
            std::string::npos);
}

}  // namespace
