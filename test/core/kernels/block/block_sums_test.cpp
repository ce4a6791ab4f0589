#include "kernels/block/block_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// The mean of the parabolas through the pixels at -1, 0, 1 and at 0, 1, 2 of a place.
double greyAt(const cv::Mat& image, int v, double x) {
  const int i = static_cast<int>(x);
  const double t = x - i;
  const auto p = [&](int k) { return static_cast<double>(image.at<uchar>(v, i + k)); };
  const double first = p(0) + t * (p(1) - p(-1)) / 2 + t * t * (p(1) - 2 * p(0) + p(-1)) / 2;
  const double s = t - 1;
  const double second = p(1) + s * (p(2) - p(0)) / 2 + s * s * (p(2) - 2 * p(1) + p(0)) / 2;
  return (first + second) / 2;
}

TEST(BlockSums, AreOfWhatTheImageHasAtThePlaces) {
  const cv::Mat image = test::randomImage(20, 80, CV_8UC1, 3);
  const std::vector<float> grey = test::randomValues<float>(kBlockWidth * kBlockHeight, -50, 50, 4);
  const std::vector<float> slope = test::randomValues<float>(kBlockWidth * kBlockHeight, -20, 20, 5);
  constexpr float kReference = 120;
  for (const float step : {0.8F, 0.96F, 0.995F, 1.F, 1.004F, 1.05F, 1.3F})
    for (const double down : {-0.4, 0.0, 0.23})
      for (const double first : {20.0, 21.37, 22.98}) {
        const BlockSums sums = addUp(image, 5, first, down, step, kReference, grey.data(), slope.data());
        double r = 0, squares = 0, greys = 0, slopes = 0;
        for (int y = 0; y < kBlockHeight; ++y)
          for (int x = 0; x < kBlockWidth; ++x) {
            const double value = greyAt(image, 5 + y, first + down * y + step * x) - kReference;
            r += value;
            squares += value * value;
            greys += value * grey[y * kBlockWidth + x];
            slopes += value * slope[y * kBlockWidth + x];
          }
        const double tolerance = 2e-5 * squares;
        EXPECT_NEAR(sums.r, r, tolerance) << step << ' ' << first;
        EXPECT_NEAR(sums.squares, squares, tolerance) << step << ' ' << first;
        EXPECT_NEAR(sums.greys, greys, tolerance) << step << ' ' << first;
        EXPECT_NEAR(sums.slopes, slopes, tolerance) << step << ' ' << first;
      }
}

TEST(BlockRow, IsSummedUp) {
  BlockRow row;
  float sum = 0;
  for (int x = 0; x < kBlockWidth; ++x) sum += row[x] = static_cast<float>(x * x - 7);
  EXPECT_EQ(sumOf(row), sum);
}

}  // namespace
}  // namespace uav_landing
