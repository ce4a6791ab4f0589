#include "image/input/resampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/core.hpp>

namespace uav_landing {
namespace {

/// Where the pixel of a row and column comes from, px.
using Place = std::function<cv::Point2d(int u, int v)>;

/// Resamples noise and compares each pixel with the four pixels around its place, weighed by 32 times 32
/// parts and rounded; with 0 where one of them that counts is outside.
void expectInterpolated(const cv::Size& source, const cv::Size& size, const Place& place) {
  cv::Mat raw(source, CV_8UC1);
  cv::RNG random(7);
  random.fill(raw, cv::RNG::UNIFORM, 0, 256);
  cv::Mat map1(size, CV_16SC2), map2(size, CV_16UC1), mask(size, CV_8UC1), expected(size, CV_8UC1);
  int inside_count = 0;
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const cv::Point2d p = place(u, v);
      const int x32 = cvRound(32 * p.x), y32 = cvRound(32 * p.y);
      const int x = x32 >> 5, y = y32 >> 5, right = x32 & 31, below = y32 & 31;
      map1.at<cv::Vec2s>(v, u) = {static_cast<short>(x), static_cast<short>(y)};
      map2.at<ushort>(v, u) = static_cast<ushort>(32 * below + right);
      const bool inside =
          x >= 0 && y >= 0 && x + (right > 0) < source.width && y + (below > 0) < source.height;
      mask.at<uchar>(v, u) = inside ? 255 : 0;
      inside_count += inside ? 1 : 0;
      const auto at = [&](int i, int j, int weight) {
        return weight == 0 ? 0 : weight * raw.at<uchar>(y + j, x + i);
      };
      const int sum = !inside ? 0
                              : at(0, 0, (32 - right) * (32 - below)) + at(1, 0, right * (32 - below)) +
                                    at(0, 1, (32 - right) * below) + at(1, 1, right * below);
      expected.at<uchar>(v, u) = static_cast<uchar>((sum + 512) / 1024);
    }
  ASSERT_GE(inside_count, size.area() / 4);
  cv::Mat result;
  const Resampler resampler(map1, map2, mask, source);
  resampler.resample(raw, result);
  EXPECT_EQ(cv::norm(result, expected, cv::NORM_INF), 0);
  // A part of a larger image, as with a region of interest: rows farther apart than they are long.
  cv::Mat larger(source.height + 5, source.width + 11, CV_8UC1, cv::Scalar(99));
  raw.copyTo(larger(cv::Rect({4, 3}, source)));
  resampler.resample(larger(cv::Rect({4, 3}, source)), result);
  EXPECT_EQ(cv::norm(result, expected, cv::NORM_INF), 0);
}

cv::Point2d turned(double u, double v, double angle, double scale, cv::Point2d centre) {
  u -= centre.x;
  v -= centre.y;
  return {centre.x + scale * (u * std::cos(angle) - v * std::sin(angle)),
          centre.y + scale * (u * std::sin(angle) + v * std::cos(angle))};
}

TEST(Resampler, InterpolatesAlmostUprightImages) {
  expectInterpolated({320, 240}, {320, 240}, [](int u, int v) {
    return turned(u, v, 0.03, 0.97, {161, 119});
  });
}
TEST(Resampler, InterpolatesImagesOfWhichPartIsMissing) {
  expectInterpolated({320, 240}, {320, 240}, [](int u, int v) {
    return turned(u, v, -0.1, 1.1, {150, 130});
  });
}
TEST(Resampler, InterpolatesRowsThatAreNoMultipleOfItsSteps) {
  for (int width = 1; width < 40; ++width)
    expectInterpolated({40, 30}, {width, 30}, [](int u, int v) {
      return turned(u, v, 0.02, 0.99, {10, 15});
    });
}
TEST(Resampler, InterpolatesSourcesThatLieFarApart) {
  expectInterpolated({640, 480}, {210, 160}, [](int u, int v) { return cv::Point2d(3.04 * u, 3.01 * v); });
  expectInterpolated({320, 240}, {320, 240}, [](int u, int v) { return turned(u, v, 1.2, 0.9, {161, 119}); });
}
TEST(Resampler, InterpolatesUpToTheLastRowAndColumn) {
  const Place shifted = [](int u, int v) { return cv::Point2d(u + 0.25, v + 0.75); };
  expectInterpolated({40, 30}, {40, 30}, shifted);
  expectInterpolated({40, 30}, {40, 30}, [](int u, int v) { return cv::Point2d(u, v); });
  for (int side = 2; side < 20; ++side) expectInterpolated({side, side}, {side, side}, shifted);
}

TEST(Resampler, GivesNothingOfImagesTooSmallToInterpolate) {
  const cv::Mat map1(3, 9, CV_16SC2, cv::Scalar(0, 0)), map2(3, 9, CV_16UC1, cv::Scalar(0)),
      mask(3, 9, CV_8UC1, cv::Scalar(0));
  cv::Mat result;
  Resampler(map1, map2, mask, {1, 1}).resample(cv::Mat(1, 1, CV_8UC1, cv::Scalar(200)), result);
  EXPECT_EQ(result.size(), mask.size());
  EXPECT_EQ(cv::countNonZero(result), 0);
}

}  // namespace
}  // namespace uav_landing
