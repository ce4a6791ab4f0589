#include "stereo/bands/texture_bands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr int kRows = 128;
const cv::Size kSize(256, kRows);

cv::Mat wave(double period) {
  cv::Mat image(kSize, CV_32F);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      image.at<float>(v, u) = static_cast<float>(std::sin(2 * M_PI * (u + 0.3 * v) / period));
  return image;
}

/// Root mean square away from the borders.
double size(const cv::Mat& band) {
  const int margin = band.rows / 4;
  const cv::Mat inside = band(cv::Rect(margin, margin, band.cols - 2 * margin, band.rows - 2 * margin));
  return cv::norm(inside) / std::sqrt(inside.total());
}

/// What is left of a wave by a Gaussian.
double kept(double sigma, double period) {
  const double frequency = 2 * M_PI / period * std::hypot(1, 0.3);
  return std::exp(-0.5 * std::pow(sigma * frequency, 2));
}

TEST(TextureBands, HoldWhatTwoGaussiansDifferBy) {
  const double sigmas[] = {0, 1, 2.5, 6.4};
  for (const double period : {3.0, 6.0, 12.0, 30.0}) {
    TextureBands bands(kSize);
    bands.split(wave(period));
    for (int i = 0; i < TextureBands::kBands; ++i) {
      const double expected = (kept(sigmas[i], period) - kept(sigmas[i + 1], period)) / std::sqrt(2);
      EXPECT_NEAR(size(bands[i]), expected, 0.06) << "band " << i << ", " << period << " px a period";
    }
  }
}

TEST(TextureBands, HoldOfNoiseWhatTheySay) {
  cv::Mat noise(512, 512, CV_32F);
  cv::RNG(1).fill(noise, cv::RNG::NORMAL, 0, 1);
  TextureBands bands(noise.size());
  bands.split(noise);
  const double ratio = std::pow(size(bands[2]) / size(bands[0]), 2);
  EXPECT_NEAR(ratio, TextureBands::kWhiteCoarsest, 0.1 * TextureBands::kWhiteCoarsest);
}

TEST(TextureBands, LeaveOutAnOffset) {
  cv::Mat image = wave(8), brighter = image + 100;
  TextureBands bands(kSize), of_brighter(kSize);
  bands.split(image);
  of_brighter.split(brighter);
  for (int i = 0; i < TextureBands::kBands; ++i)
    EXPECT_LT(cv::norm(bands[i], of_brighter[i], cv::NORM_INF), 1e-3) << i;
}

TEST(TextureBands, TakeNothingFromRowsBesideTheImage) {
  cv::Mat memory = wave(8);
  memory.rowRange(0, 40) = 1e6;
  TextureBands of_part(kSize), of_copy(kSize);
  of_part.split(wave(5));  // of more rows: its memory is used again
  of_part.split(memory.rowRange(40, kRows));
  of_copy.split(memory.rowRange(40, kRows).clone());
  for (int i = 0; i < TextureBands::kBands; ++i) {
    ASSERT_EQ(of_part[i].size(), of_copy[i].size());
    EXPECT_EQ(cv::norm(of_part[i], of_copy[i], cv::NORM_INF), 0) << i;
  }
}

}  // namespace
}  // namespace uav_landing
