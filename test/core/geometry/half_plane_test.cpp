#include "geometry/half_plane.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace uav_landing {
namespace {

void expectHalfPlane(double a, double b, double c) {
  cv::Mat mask(13, 17, CV_8UC1, cv::Scalar(255));
  mask.at<uchar>(6, 8) = 0;
  cv::Mat kept;
  keepHalfPlane(mask, a, b, c, kept);
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const bool wanted = a * u + b * v + c >= 0 && !(u == 8 && v == 6);
      EXPECT_EQ(kept.at<uchar>(v, u) != 0, wanted) << a << " " << b << " " << c << " at " << u << ", " << v;
    }
  }
  keepHalfPlane(mask, a, b, c, mask);
  EXPECT_EQ(cv::countNonZero(mask != kept), 0) << a << " " << b << " " << c << " in place";
}

TEST(KeepHalfPlane, ClearsWhatLiesOnTheOtherSide) {
  for (const double a : {-1.3, -0.2, 0.0, 0.37, 2.1}) {
    for (const double b : {-0.9, 0.0, 0.8}) {
      for (const double c : {-30.5, -3.3, 0.1, 4.7, 40.2}) expectHalfPlane(a, b, c);
    }
  }
}

TEST(KeepHalfPlane, KeepsNothingOfNone) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  for (const double wrong : {nan, infinite, -infinite})
    for (int i = 0; i < 3; ++i) {
      std::array<double, 3> line = {0.4, 1, 2};
      line[i] = wrong;
      cv::Mat mask(13, 17, CV_8UC1, cv::Scalar(255));
      keepHalfPlane(mask, line[0], line[1], line[2], mask);
      EXPECT_EQ(cv::countNonZero(mask), 0) << wrong << " " << i;
    }
}

// A camera of 100 px that looks down by atan(0.2): its horizon is 20 px above the middle row, and one px of
// 100 rows more is left out.
TEST(HalfPlane, BelowTheHorizonIsWhatTheGroundCanBeSeenIn) {
  const cv::Mat mask(100, 80, CV_8UC1, cv::Scalar(255));
  Eigen::Matrix3d K;
  K << 100, 0, 40, 0, 100, 50, 0, 0, 1;
  cv::Mat kept;
  keepBelowHorizon(mask, K, Eigen::Vector3d(0, 1, 0.2).normalized(), kept);
  for (const int u : {0, 40, 79}) {
    EXPECT_EQ(kept.at<uchar>(30, u), 0) << u;
    EXPECT_EQ(kept.at<uchar>(32, u), 255) << u;
  }
  // Rolled by atan(0.5), right side down in the picture.
  keepBelowHorizon(mask, K, Eigen::Vector3d(-0.5, 1, 0).normalized(), kept);
  EXPECT_EQ(kept.at<uchar>(68, 79), 0);
  EXPECT_EQ(kept.at<uchar>(72, 79), 255);
  EXPECT_EQ(kept.at<uchar>(29, 0), 0);
  EXPECT_EQ(kept.at<uchar>(33, 0), 255);
}

}  // namespace
}  // namespace uav_landing
