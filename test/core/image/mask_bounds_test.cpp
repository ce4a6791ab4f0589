#include "image/input/mask_bounds.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <vector>

namespace uav_landing {
namespace {

cv::Mat nothing() { return cv::Mat(30, 40, CV_8UC1, cv::Scalar(0)); }

TEST(MaskBounds, HoldAllThatIsSet) {
  cv::Mat mask = nothing();
  mask.at<uchar>(7, 31) = 1;
  EXPECT_EQ(boundsOf(mask), cv::Rect(31, 7, 1, 1));
  mask.at<uchar>(12, 3) = 255;
  EXPECT_EQ(boundsOf(mask), cv::Rect(3, 7, 29, 6));
  mask.at<uchar>(9, 38) = 128;
  EXPECT_EQ(boundsOf(mask), cv::Rect(3, 7, 36, 6));
}
TEST(MaskBounds, ReachTheBorders) {
  cv::Mat mask = nothing();
  mask.at<uchar>(0, 5) = mask.at<uchar>(29, 6) = mask.at<uchar>(4, 0) = mask.at<uchar>(5, 39) = 255;
  EXPECT_EQ(boundsOf(mask), cv::Rect(0, 0, 40, 30));
  EXPECT_EQ(boundsOf(cv::Mat(30, 1, CV_8UC1, cv::Scalar(255))), cv::Rect(0, 0, 1, 30));
}
TEST(MaskBounds, AreThoseOfRoundShapesInPartsOfImages) {
  cv::RNG random(4);
  for (int i = 0; i < 100; ++i) {
    cv::Mat mask(60, 70, CV_8UC1, cv::Scalar(255));
    cv::Mat part = mask(cv::Rect(9, 8, 40, 30));
    part.setTo(0);
    cv::circle(part, {random.uniform(-9, 50), random.uniform(-9, 40)}, random.uniform(0, 20), 255, -1);
    std::vector<cv::Point> points;
    cv::findNonZero(part, points);
    EXPECT_EQ(boundsOf(part), points.empty() ? cv::Rect() : cv::boundingRect(points));
  }
}
TEST(MaskBounds, AreEmptyWhereNothingIsSet) {
  EXPECT_EQ(boundsOf(nothing()), cv::Rect());
  EXPECT_EQ(boundsOf(cv::Mat()), cv::Rect());
}

}  // namespace
}  // namespace uav_landing
