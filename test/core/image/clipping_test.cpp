#include "image/input/clipping.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

TEST(Clipping, IsSeenInTheWindowAndNotBesideIt) {
  cv::Mat image(20, 30, CV_32F, cv::Scalar(200));
  image.at<float>(8, 12) = 255;
  EXPECT_TRUE(isClipped(image, {12, 8}, 5));
  EXPECT_TRUE(isClipped(image, {7.4, 12.6}, 5)) << "in the corner";
  EXPECT_FALSE(isClipped(image, {6.4, 12}, 5));
  EXPECT_FALSE(isClipped(image, {12, 14}, 5));
  image.at<float>(8, 12) = 230;
  EXPECT_FALSE(isClipped(image, {12, 8}, 5)) << "bright, but seen";
}

TEST(Clipping, LooksAtWhatOfTheWindowIsInTheImage) {
  cv::Mat image(20, 30, CV_32F, cv::Scalar(100));
  image.at<float>(0, 29) = 255;
  EXPECT_TRUE(isClipped(image, {31, -2}, 5));
  EXPECT_FALSE(isClipped(image, {-2, 19}, 5));
  EXPECT_FALSE(isClipped(image, {100, 100}, 5)) << "outside";
}

}  // namespace
}  // namespace uav_landing
