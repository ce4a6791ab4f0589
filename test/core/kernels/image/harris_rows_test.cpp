#include "kernels/image/harris_rows.h"

#include <gtest/gtest.h>

#include "support/random_values.h"

namespace uav_landing {
namespace {

constexpr double kHarris = 0.04;

/// Of the gradients by Sobel's kernels, summed over 3 x 3, pixel by pixel.
double response(const cv::Mat_<double>& image, int u, int v) {
  double a = 0, b = 0, c = 0;
  for (int y = v - 1; y <= v + 1; ++y)
    for (int x = u - 1; x <= u + 1; ++x) {
      double gx = 0, gy = 0;
      for (int k = -1; k <= 1; ++k) {
        const int weight = k == 0 ? 2 : 1;
        gx += weight * (image(y + k, x + 1) - image(y + k, x - 1));
        gy += weight * (image(y + 1, x + k) - image(y - 1, x + k));
      }
      a += gx * gx;
      b += gx * gy;
      c += gy * gy;
    }
  return a * c - b * b - kHarris * (a + c) * (a + c);
}

/// Of equal neighbours the last one counts.
bool isMaximum(HarrisRows& rows, int u, int v) {
  const float here = rows.response(v)[u];
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      if (i == 0 && j == 0) continue;
      const bool before = j < 0 || (j == 0 && i < 0);
      const float other = rows.response(v + j)[u + i];
      if (before ? here <= other : here < other) return false;
    }
  return true;
}

void expectAsDefined(const cv::Mat& image) {
  HarrisRows rows(image, kHarris);
  for (int v = 2; v + 2 < image.rows; ++v) {
    rows.compute(v);
    EXPECT_EQ(rows.response(v)[0], 0);
    EXPECT_EQ(rows.response(v)[image.cols - 2], 0);
    for (int u = 2; u + 2 < image.cols; ++u) {
      const double expected = response(image, u, v);
      ASSERT_NEAR(rows.response(v)[u], expected, 1e-5 * std::abs(expected) + 1e6) << u << ' ' << v;
    }
    if (v < 4) continue;
    const std::uint64_t* marks = rows.maxima(v - 1);
    for (int u = 2; u + 2 < image.cols; ++u) {
      const bool marked = (marks[u / HarrisRows::kBlock] >> (u % HarrisRows::kBlock) & 1) != 0;
      ASSERT_EQ(marked, isMaximum(rows, u, v - 1)) << u << ' ' << v - 1;
    }
  }
}

TEST(HarrisRows, AreOfTheGradientsAroundEachPixel) {
  for (const int columns : {5, 17, 63, 64, 65, 130}) {
    expectAsDefined(test::randomImage(11, columns, CV_8UC1, columns));
    expectAsDefined(test::randomImage(11, columns, CV_32F, columns));
  }
}

TEST(HarrisRows, CountTheLastOfEqualNeighbours) {
  // Bright points on dark ground have the same response all around them.
  cv::Mat image(12, 40, CV_8UC1, cv::Scalar(10));
  image.at<uchar>(5, 9) = image.at<uchar>(6, 20) = image.at<uchar>(6, 21) = 200;
  expectAsDefined(image);
}

}  // namespace
}  // namespace uav_landing
