#include "kernels/image/rip_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <utility>

namespace uav_landing {
namespace {

constexpr int kSize = 32;
constexpr int kLevels = 6;

cv::Mat someTexels() {
  cv::Mat texels(kSize, kSize, CV_32F);
  cv::RNG(5).fill(texels, cv::RNG::NORMAL, 0, 1);
  return texels;
}

/// The mean over whole blocks of 2^i x 2^j texels.
cv::Mat blocks(const cv::Mat& texels, int i, int j) {
  const int width = 1 << i, height = 1 << j;
  cv::Mat means(kSize / height, kSize / width, CV_32F);
  for (int v = 0; v < means.rows; ++v)
    for (int u = 0; u < means.cols; ++u)
      means.at<float>(v, u) = static_cast<float>(cv::mean(texels({u * width, v * height, width, height}))[0]);
  return means;
}

/// Quadratic B-spline, by its definition.
float spline(float t) {
  const float away = std::abs(t);
  if (away <= 0.5f) return 0.75f - t * t;
  return away < 1.5f ? 0.5f * (1.5f - away) * (1.5f - away) : 0.0f;
}

/// Each texel of a level weighted by the spline, in the tile that repeats.
float interpolate(const cv::Mat& level, float x, float y) {
  float sum = 0;
  for (int v = static_cast<int>(std::floor(y)) - 2; v <= std::floor(y) + 2; ++v)
    for (int u = static_cast<int>(std::floor(x)) - 2; u <= std::floor(x) + 2; ++u)
      sum += spline(x - (static_cast<float>(u) + 0.5f)) * spline(y - (static_cast<float>(v) + 0.5f)) *
             level.at<float>((v + 64 * level.rows) % level.rows, (u + 64 * level.cols) % level.cols);
  return sum;
}

/// Level of a width and the share of the next one. The logarithm is linear between powers of two.
std::pair<int, float> levelOf(float width) {
  const float clamped = std::clamp(width, 1.0f, static_cast<float>(kSize));
  const int whole = std::min(static_cast<int>(std::floor(std::log2(clamped))), kLevels - 2);
  return {whole, clamped / static_cast<float>(1 << whole) - 1};
}

float plainMean(const cv::Mat& texels, float x, float y, float width, float height) {
  const auto [i, i_share] = levelOf(width);
  const auto [j, j_share] = levelOf(height);
  float mean = 0;
  for (const int di : {0, 1}) {
    for (const int dj : {0, 1}) {
      const float share = (di == 1 ? i_share : 1 - i_share) * (dj == 1 ? j_share : 1 - j_share);
      mean += share * interpolate(blocks(texels, i + di, j + dj), x / static_cast<float>(1 << (i + di)),
                                  y / static_cast<float>(1 << (j + dj)));
    }
  }
  return mean;
}

TEST(RipMap, IsWhatPlainLoopsGive) {
  const cv::Mat texels = someTexels();
  const RipMap map(texels);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-100, 100), octaves(-1, 7);
  for (int i = 0; i < 2000; ++i) {
    const float x = place(random), y = place(random);
    const float width = std::exp2(octaves(random)), height = std::exp2(octaves(random));
    EXPECT_NEAR(map.mean(x, y, width, height), plainMean(texels, x, y, width, height), 2e-5)
        << x << " " << y << " " << width << " " << height;
  }
}

TEST(RipMap, ARectangleOfWholeTexelsAtTheirCentreIsTheSplineOfThem) {
  cv::Mat texels = cv::Mat::zeros(kSize, kSize, CV_32F);
  texels.at<float>(0, kSize - 1) = 1;
  const RipMap map(texels);
  EXPECT_FLOAT_EQ(map.mean(kSize - 0.5f, 0.5f, 1, 1), 0.75f * 0.75f);
  EXPECT_FLOAT_EQ(map.mean(0.5f, 0.5f, 1, 1), 0.125f * 0.75f) << "it repeats along x";
  EXPECT_FLOAT_EQ(map.mean(-0.5f, kSize - 0.5f, 1, 1), 0.75f * 0.125f) << "and along y";
  EXPECT_FLOAT_EQ(map.mean(1.5f, 0.5f, 1, 1), 0) << "three texels count";
  EXPECT_FLOAT_EQ(map.mean(-0.5f, 2.5f, 1, 1), 0);
}

TEST(RipMap, OverTheWholeSideItIsTheMeanOfAll) {
  const cv::Mat texels = someTexels();
  EXPECT_NEAR(RipMap(texels).mean(7, 11, kSize, kSize), cv::mean(texels)[0], 1e-6);
  EXPECT_NEAR(RipMap(texels).mean(7, 11, 1000, 1000), cv::mean(texels)[0], 1e-6);
}

TEST(RipMap, RefusesWhatIsNoSquareOfAPowerOfTwo) {
  EXPECT_THROW(RipMap(cv::Mat(8, 4, CV_32F)), cv::Exception);
  EXPECT_THROW(RipMap(cv::Mat(6, 6, CV_32F)), cv::Exception);
  EXPECT_THROW(RipMap(cv::Mat(8, 8, CV_8U)), cv::Exception);
  EXPECT_THROW(RipMap(cv::Mat(1, 1, CV_32F)), cv::Exception);
  EXPECT_THROW(RipMap(cv::Mat(0, 0, CV_32F)), cv::Exception);
}

}  // namespace
}  // namespace uav_landing
