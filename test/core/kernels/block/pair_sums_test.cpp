#include "kernels/block/pair_sums.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(PairSums, AreOverThePixelsOfBothImages) {
  const cv::Mat_<float> left = test::randomImage(30, 50, CV_32F, 3),
                        right = test::randomImage(30, 50, CV_32F, 4);
  for (const int width : {8, 16})
    for (const int height : {1, 4, 8}) {
      const int u0 = 9, v0 = 5;
      const PairSums sums =
          addUpPair(left.ptr<float>(v0) + u0, right.ptr<float>(v0) + u0, left.cols, width, height);
      double ll = 0, rr = 0, lr = 0, sl = 0, sr = 0, ss = 0, sd = 0, sg = 0;
      for (int v = v0; v < v0 + height; ++v)
        for (int u = u0; u < u0 + width; ++u) {
          const double l = left(v, u), r = right(v, u), slope = (left(v, u + 1) - left(v, u - 1)) / 2.0;
          // Of fourth order.
          const double down =
              (left(v - 2, u) - 8.0 * left(v - 1, u) + 8.0 * left(v + 1, u) - left(v + 2, u)) / 12;
          const double beside =
              (right(v, u - 2) - 8.0 * right(v, u - 1) + 8.0 * right(v, u + 1) - right(v, u + 2)) / 12;
          ll += l * l;
          rr += r * r;
          lr += l * r;
          sl += slope * l;
          sr += slope * r;
          ss += slope * slope;
          sd += slope * down;
          sg += slope * beside;
        }
      const double tolerance = 1e-5 * (ll + rr);
      EXPECT_NEAR(sums.left, ll, tolerance);
      EXPECT_NEAR(sums.right, rr, tolerance);
      EXPECT_NEAR(sums.products, lr, tolerance);
      EXPECT_NEAR(sums.slope_left, sl, tolerance);
      EXPECT_NEAR(sums.slope_right, sr, tolerance);
      EXPECT_NEAR(sums.slopes, ss, tolerance);
      EXPECT_NEAR(sums.down, sd, tolerance);
      EXPECT_NEAR(sums.signal, sg, tolerance);
    }
}

}  // namespace
}  // namespace uav_landing
