#include "image/input/row_alternation.h"

#include <gtest/gtest.h>

#include "support/interlaced_picture.h"

namespace uav_landing {
namespace {

using test::interlaced;
using test::sharpened;

TEST(RowAlternation, IsAboveOneWhereRowsAreOfTwoTimes) {
  EXPECT_LT(rowAlternation(interlaced(0)), 0.8);
  EXPECT_GT(rowAlternation(interlaced(3)), 1.5);
  EXPECT_NEAR(rowAlternation(interlaced(0, 40)), 1, 0.15) << "noise";
  EXPECT_EQ(rowAlternation(cv::Mat(20, 20, CV_8UC1, cv::Scalar(5))), 0);
}

TEST(RowAlternation, IsAboveOneInNoiseThatACameraSharpened) {
  for (const double centre : {2.2, 3.0, 5.0}) EXPECT_GT(rowAlternation(sharpened(centre)), 1.1) << centre;
}

}  // namespace
}  // namespace uav_landing
