#include "uav_landing/geometry/half_plane.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

void expectHalfPlane(double a, double b, double c) {
  cv::Mat mask(13, 17, CV_8UC1, cv::Scalar(255));
  mask.at<uchar>(6, 8) = 0;
  keepHalfPlane(mask, a, b, c);
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const bool kept = a * u + b * v + c >= 0 && !(u == 8 && v == 6);
      EXPECT_EQ(mask.at<uchar>(v, u) != 0, kept) << a << " " << b << " " << c << " at " << u << ", " << v;
    }
  }
}

TEST(KeepHalfPlane, ClearsWhatLiesOnTheOtherSide) {
  for (const double a : {-1.3, -0.2, 0.0, 0.37, 2.1}) {
    for (const double b : {-0.9, 0.0, 0.8}) {
      for (const double c : {-30.5, -3.3, 0.1, 4.7, 40.2}) expectHalfPlane(a, b, c);
    }
  }
}

}  // namespace
}  // namespace uav_landing
