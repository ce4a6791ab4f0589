#include "image/input/grey_range.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

/// Noise between these values, both included, in equal shares.
cv::Mat between(int low, int high) {
  cv::Mat image(120, 160, CV_16UC1);
  cv::randu(image, low, high + 1);
  return image;
}

GreyRange foundIn(int low, int high) {
  GreyRangeFinder finder(0);
  GreyRange range;
  for (int i = 0; i < 15; ++i) range = finder.follow(between(low, high), between(low, high));
  return range;
}

TEST(GreyRange, IsThatOfTheBitsThatAreUsed) {
  for (const int bits : {10, 12, 14, 16}) {
    const int largest = (1 << bits) - 1;
    for (const double share : {0.95, 0.5}) {
      const GreyRange range = foundIn(0, static_cast<int>(share * largest));
      EXPECT_EQ(range.black, 0) << bits;
      EXPECT_EQ(range.white, largest) << bits;
    }
  }
}

TEST(GreyRange, OfAThermalCameraIsThatOfTheSceneWithAMargin) {
  const GreyRange range = foundIn(29000, 29510);
  EXPECT_NEAR(range.black, 29000 - 0.25 * 510, 4);
  EXPECT_NEAR(range.white, 29510 + 0.25 * 510, 4);
}

TEST(GreyRange, IsOneForBothCameras) {
  GreyRangeFinder finder(0);
  for (int i = 0; i < 15; ++i) finder.follow(between(0, 4000), between(0, 3500));
  const GreyRange range = finder.range();
  finder.follow(between(0, 500), between(0, 400));
  EXPECT_EQ(finder.range(), range) << "and is kept when the scene gets darker";
  EXPECT_EQ(range.white, 4095);
}

TEST(GreyRange, IsNotSpoiltByFirstPicturesWithoutAnything) {
  GreyRangeFinder finder(0);
  for (const int nothing : {0, 65535}) finder.follow(between(nothing, nothing), between(nothing, nothing));
  for (int i = 0; i < 15; ++i) finder.follow(between(29000, 29510), between(29000, 29510));
  EXPECT_NEAR(finder.range().black, 29000 - 0.25 * 510, 4);
  EXPECT_NEAR(finder.range().white, 29510 + 0.25 * 510, 4);
}

TEST(GreyRange, IsNotSpoiltByAShutterThatStaysClosedForLong) {
  for (const int nothing : {0, 65535}) {
    GreyRangeFinder finder(0);
    for (int i = 0; i < 30; ++i) finder.follow(between(nothing, nothing), between(nothing, nothing));
    for (int i = 0; i < 30; ++i) finder.follow(between(29000, 29510), between(nothing, nothing));
    EXPECT_NEAR(finder.range().black, 29000 - 0.25 * 510, 4) << nothing;
    EXPECT_NEAR(finder.range().white, 29510 + 0.25 * 510, 4) << nothing;
  }
}

TEST(GreyRange, IsNotSpoiltByLaterPicturesThatAreBlankOrBroken) {
  GreyRangeFinder finder(0);
  const cv::Mat scene = between(29000, 29510);
  for (int i = 0; i < 15; ++i) finder.follow(scene, scene);
  const GreyRange range = finder.range();
  for (const int nothing : {0, 65535})
    for (int i = 0; i < 10; ++i) finder.follow(between(nothing, nothing + 3), scene);
  EXPECT_EQ(finder.range(), range) << "blank";
  for (int i = 0; i < 20; ++i) finder.follow(scene, i % 5 == 4 ? scene : between(0, 65535));
  EXPECT_EQ(finder.range(), range) << "never five pairs in a row";
}

TEST(GreyRange, HoldsBothCamerasFromTheFirstPairOn) {
  GreyRangeFinder finder(0);
  for (int i = 0; i < 15; ++i) {
    const GreyRange range = finder.follow(between(29000, 29510), between(30000, 30510));
    EXPECT_LT(range.black, 29000) << i;
    EXPECT_GT(range.white, 30510) << i;
    EXPECT_LT(range.white, 31000) << i;
  }
}

TEST(GreyRange, GrowsWhenTheSceneGetsBrighterThanItsBits) {
  GreyRangeFinder finder(0);
  for (int i = 0; i < 15; ++i) finder.follow(between(0, 900), between(0, 900));
  EXPECT_EQ(finder.range().white, 1023);
  for (int i = 0; i < 4; ++i) finder.follow(between(0, 3000), between(0, 3000));
  EXPECT_EQ(finder.range().white, 1023);
  finder.follow(between(0, 3000), between(0, 3000));
  EXPECT_EQ(finder.range().white, 4095);
  for (int i = 0; i < 4; ++i) finder.follow(between(0, 15000), between(0, 15000));
  finder.follow(between(0, 60000), between(0, 15000));
  EXPECT_EQ(finder.range().white, 16383) << "only what all five pairs ask for";
  finder.reset();
  finder.follow(between(0, 900), between(0, 900));
  EXPECT_EQ(finder.range().white, 1023) << "anew";
}

TEST(GreyRange, MayBeGiven) {
  GreyRangeFinder finder(12);
  EXPECT_EQ(finder.follow(between(0, 900), between(0, 900)).white, 4095);
  cv::Mat mono;
  finder.range().toMono8((cv::Mat_<uint16_t>(1, 4) << 0, 2048, 4095, 60000), mono);
  EXPECT_EQ(mono.at<uchar>(0), 0);
  EXPECT_NEAR(mono.at<uchar>(1), 128, 1);
  EXPECT_EQ(mono.at<uchar>(2), 255);
  EXPECT_EQ(mono.at<uchar>(3), 255) << "saturated";
  EXPECT_FALSE(finder.exceeded());
  finder.follow(between(0, 4095), between(0, 4095) * 16);
  EXPECT_TRUE(finder.exceeded()) << "the highest bits are used";
  EXPECT_EQ(finder.range().white, 4095);
}

TEST(GreyRange, StaysAsItIsWithoutImagesOf16Bits) {
  GreyRangeFinder finder(0);
  EXPECT_EQ(finder.follow({}, {}), GreyRange());
}

}  // namespace
}  // namespace uav_landing
