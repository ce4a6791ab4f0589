#include "image_input.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <utility>

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

TEST(ImageInput, EveryBayerPatternOf16BitsIsUnderstood) {
  for (const char* encoding : {"bayer_rggb16", "bayer_bggr16", "bayer_gbrg16", "bayer_grbg16"}) {
    const auto image = makeImage(encoding, 2);
    image->height = 4;
    image->data.resize(32);
    for (size_t i = 0; i < 16; ++i) reinterpret_cast<uint16_t*>(image->data.data())[i] = 600;
    const auto mono = toMono8(image, announcing(4, 4), "left", {0, 1023});
    ASSERT_TRUE(mono.has_value()) << encoding;
    EXPECT_NEAR((*mono)->image.at<uint8_t>(1, 2), 600 * 255 / 1023, 1) << encoding;
  }
}

TEST(ImageInput, ARedPixelIsRedInEveryBayerPattern) {
  // Of 2 x 2 pixels the red one is bright. Grey is 0.299 of it, whatever its place.
  const std::pair<const char*, int> red_at[] = {
      {"bayer_rggb8", 0}, {"bayer_bggr8", 3}, {"bayer_gbrg8", 2}, {"bayer_grbg8", 1}};
  for (const auto& [encoding, place] : red_at) {
    auto image = boost::make_shared<sensor_msgs::Image>();
    image->width = image->height = image->step = 8;
    image->encoding = encoding;
    for (int v = 0; v < 8; ++v)
      for (int u = 0; u < 8; ++u) image->data.push_back(2 * (v % 2) + u % 2 == place ? 200 : 0);
    const auto mono = toMono8(image, announcing(8, 8), "left");
    ASSERT_TRUE(mono.has_value()) << encoding;
    EXPECT_NEAR((*mono)->image.at<uint8_t>(4, 4), 0.299 * 200, 2) << encoding;
  }
}

TEST(ImageInput, NamesOfOpenCVAreTakenForGreyOrBlueGreenRed) {
  const std::pair<const char*, uint32_t> alike[] = {
      {"8UC1", 1}, {"8UC3", 3}, {"8UC4", 4}, {"bgra8", 4}, {"rgba8", 4}};
  for (const auto& [encoding, bytes] : alike) {
    const auto mono = toMono8(makeImage(encoding, bytes), announcing(4, 2), "left");
    ASSERT_TRUE(mono.has_value()) << encoding << mono.error().detail;
    EXPECT_EQ((*mono)->image.at<uint8_t>(1, 3), 100) << encoding;
  }
  const auto blue = makeImage("8UC3", 3);
  blue->data[0] = 255, blue->data[1] = 0, blue->data[2] = 0;
  EXPECT_NEAR((*toMono8(blue, announcing(4, 2), "left"))->image.at<uint8_t>(0, 0), 0.114 * 255, 1);
}

TEST(ImageInput, OneChannelWithAnotherNameSharesTheMessagesMemory) {
  const auto image = makeImage("8UC1", 1);
  EXPECT_EQ((*toMono8(image, announcing(4, 2), "left"))->image.data, image->data.data());
}

TEST(ImageInput, OfYuvTheBrightnessIsTaken) {
  // Brightness 10, 20, 30 ... in every second byte: the second of yuv422, the first of yuy2.
  const std::pair<const char*, int> first_at[] = {
      {"yuv422", 1}, {"uyvy", 1}, {"yuv422_yuy2", 0}, {"yuyv", 0}};
  for (const auto& [encoding, first] : first_at) {
    const auto image = makeImage(encoding, 2);
    for (int i = 0; i < 8; ++i) image->data[2 * i + first] = static_cast<uint8_t>(10 * (i + 1));
    const auto mono = toMono8(image, announcing(4, 2), "left");
    ASSERT_TRUE(mono.has_value()) << encoding;
    for (int i = 0; i < 8; ++i) EXPECT_EQ((*mono)->image.at<uint8_t>(i / 4, i % 4), 10 * (i + 1)) << encoding;
  }
}

TEST(ImageInput, SixteenBitsAreStretchedByTheRange) {
  for (const char* encoding : {"mono16", "16UC1"}) {
    const auto image = makeImage(encoding, 2);
    auto* pixels = reinterpret_cast<uint16_t*>(image->data.data());
    pixels[0] = 1023, pixels[1] = 512, pixels[2] = 0;
    const auto mono = toMono8(image, announcing(4, 2), "left", {0, 1023});
    ASSERT_TRUE(mono.has_value());
    EXPECT_EQ((*mono)->image.at<uint8_t>(0, 0), 255);
    EXPECT_EQ((*mono)->image.at<uint8_t>(0, 1), 128);
    EXPECT_EQ((*mono)->image.at<uint8_t>(0, 2), 0);
  }
}

TEST(ImageInput, TheRangeIsThatOfBothImagesInEitherByteOrder) {
  const auto left = makeImage("mono16", 2), right = makeImage("bayer_rggb16", 2);
  auto* values = reinterpret_cast<uint16_t*>(left->data.data());
  for (int i = 0; i < 8; ++i) values[i] = static_cast<uint16_t>(100 * i);
  right->is_bigendian = 1;
  for (int i = 0; i < 8; ++i) {
    right->data[2 * i] = static_cast<uint8_t>((100 * i) >> 8);
    right->data[2 * i + 1] = static_cast<uint8_t>((100 * i) & 255);
  }
  PairGreyRange range(0), other(0);
  EXPECT_EQ(range.follow(left, announcing(4, 2), right, announcing(4, 2)), "");
  EXPECT_EQ(range.range(), (GreyRange{0, 1023}));
  right->data.resize(3);
  other.follow(makeImage("mono8", 1), announcing(4, 2), right, announcing(4, 2));
  EXPECT_EQ(other.range(), GreyRange());
}

/// Values from 0 to the largest one.
sensor_msgs::ImagePtr deepImage(double stamp, int largest) {
  const auto image = makeImage("mono16", 2);
  image->header.stamp = ros::Time(stamp);
  auto* values = reinterpret_cast<uint16_t*>(image->data.data());
  for (int i = 0; i < 8; ++i) values[i] = static_cast<uint16_t>(largest * i / 7);
  return image;
}

TEST(ImageInput, TheRangeIsFoundAnewWhenStampsGoBackAndAfterAReset) {
  PairGreyRange range(0);
  const auto follow = [&](double stamp, int largest) {
    const auto image = deepImage(stamp, largest);
    range.follow(image, announcing(4, 2), image, announcing(4, 2));
    return range.range().white;
  };
  EXPECT_EQ(follow(10, 4000), 4095);
  EXPECT_EQ(follow(11, 1000), 4095);
  EXPECT_EQ(follow(9, 1000), 1023);
  range.reset();
  EXPECT_EQ(follow(12, 4000), 4095);
}

TEST(ImageInput, ValuesBeyondTheGivenBitsAreToldOnce) {
  PairGreyRange range(10);
  const auto image = deepImage(10, 4000);
  EXPECT_EQ(range.follow(image, announcing(4, 2), image, announcing(4, 2)), exceededText(10));
  EXPECT_EQ(range.follow(image, announcing(4, 2), image, announcing(4, 2)), "");
  EXPECT_EQ(range.range().white, 1023);
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

TEST(ImageInput, AStepOfHalfAValueIsRefused) {
  const auto image = makeImage("mono16", 2);
  image->step = 9;
  image->data.resize(18);
  EXPECT_EQ(failureOf(image, announcing(4, 2)),
            "input_invalid: /stereo/left/image_raw: step: 9 bytes are no whole number of values of 16 bits");
  PairGreyRange range(0);
  range.follow(image, announcing(4, 2), image, announcing(4, 2));
  EXPECT_EQ(range.range(), GreyRange());
}

TEST(ImageInput, NoCalibrationSizeIsRefusedWithoutACrash) {
  EXPECT_NE(failureOf(makeImage("mono8", 1), announcing(0, 0)).find("camera_info announces 0x0"),
            std::string::npos);
}

}  // namespace
