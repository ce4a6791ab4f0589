#include "picture_watch.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <opencv2/imgproc.hpp>

#include "support/interlaced_picture.h"

namespace uav_landing {
namespace {

using test::interlaced;
using test::sharpened;

sensor_msgs::ImageConstPtr picture(int content) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->width = 4;
  image->height = 1;
  image->data = {static_cast<uint8_t>(content), 0, 1, 2};
  return image;
}

/// Which of these pairs are left out; the right picture is the left one's opposite.
std::string leftOut(PictureWatch& watch, const std::vector<int>& left, int right_offset = 0) {
  std::string out;
  for (size_t i = 0; i < left.size(); ++i) {
    const size_t j = i >= static_cast<size_t>(right_offset) ? i - right_offset : 0;
    out += watch.isRepetition(picture(left[i]), picture(255 - left[j])) ? 'x' : '.';
  }
  return out;
}

TEST(PictureWatch, LeavesOutTheSecondOfTwoWhereAllComeTwice) {
  PictureWatch watch;
  EXPECT_EQ(leftOut(watch, {1, 1, 2, 2, 3, 3, 4, 4, 5, 5}), ".x.x.x.x.x");
  EXPECT_EQ(watch.repetitions(), 5u);
  EXPECT_EQ(watch.news(), std::vector<std::string>{
                              "each pair of images comes 2 times, bit by bit the same under new stamps: the "
                              "driver runs faster than the cameras; the repetitions are left out"});
  EXPECT_TRUE(watch.news().empty()) << "said once";
}

TEST(PictureWatch, MayBeginWithTheSecondOfTwo) {
  PictureWatch watch;
  EXPECT_EQ(leftOut(watch, {1, 2, 2, 3, 3, 4, 4}), "..x.x.x");
}

TEST(PictureWatch, LeavesPicturesOfOneGreyLevelAlone) {
  PictureWatch watch;
  const auto black = boost::make_shared<sensor_msgs::Image>();
  black->data.assign(4, 0);
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(watch.isRepetition(black, black));
}

TEST(PictureWatch, LeavesPicturesOfOneValueOf16BitsAlone) {
  PictureWatch watch;
  const auto saturated = boost::make_shared<sensor_msgs::Image>();
  saturated->width = 3;
  saturated->height = 2;
  saturated->step = 6;
  for (int i = 0; i < 6; ++i) saturated->data.insert(saturated->data.end(), {255, 15});  // of 12 bits
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(watch.isRepetition(saturated, saturated));
}

TEST(PictureWatch, TakesOneOfThree) {
  PictureWatch watch;
  EXPECT_EQ(leftOut(watch, {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}), ".x..x.....xx");
}

TEST(PictureWatch, LeavesACameraThatHangsToTheTests) {
  PictureWatch watch;
  EXPECT_EQ(leftOut(watch, {1, 2, 3, 3, 3, 3, 3, 3, 4, 5}), "..........");
  EXPECT_EQ(leftOut(watch, {6, 6, 7, 7, 8, 8, 8, 8, 8}), ".....x...") << "repeated more often than before";
  EXPECT_EQ(leftOut(watch, std::vector<int>(20, 9)), std::string(20, '.'));
}

TEST(PictureWatch, LeavesOutNothingWhereTheCamerasRepeatInTurn) {
  PictureWatch watch;
  leftOut(watch, {11, 12, 13});
  EXPECT_EQ(leftOut(watch, {1, 1, 2, 2, 3, 3, 4, 4, 5, 5}, 1), "..........");
}

TEST(PictureWatch, SharpenedNoiseIsNotInterlaced) {
  for (const double centre : {2.2, 3.0, 5.0}) {
    PictureWatch watch;
    for (int i = 0; i < 30; ++i) watch.look(sharpened(centre), "/left");
    EXPECT_TRUE(watch.news().empty()) << centre;
  }
}

TEST(PictureWatch, TellsInterlacedPicturesOfLittleMotion) {
  PictureWatch watch;
  for (int i = 0; i < 30; ++i) watch.look(interlaced(1, 3), "/left");
  EXPECT_EQ(watch.news().size(), 1u);
}

TEST(PictureWatch, TellsInterlacedPicturesOnce) {
  PictureWatch watch;
  for (int i = 0; i < 30; ++i) watch.look(interlaced(0), "/left");
  EXPECT_TRUE(watch.news().empty());
  for (int i = 0; i < 30; ++i) watch.look(interlaced(3), "/left");
  const std::vector<std::string> news = watch.news();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].rfind("/left: every other row is of another image: interlaced video", 0), 0u) << news[0];
}

}  // namespace
}  // namespace uav_landing
