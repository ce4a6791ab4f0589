#include "kernels/window/strip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kernels/lanes/lanes.h"
#include "support/random_values.h"

namespace uav_landing {
namespace {

/// By linear interpolation; NaN outside the image.
double valueAt(const cv::Mat& image, int v, double x) {
  if (!(x >= 0 && x < image.cols - 1)) return NAN;
  const int i = static_cast<int>(x);
  return image.at<float>(v, i) + (x - i) * (image.at<float>(v, i + 1) - image.at<float>(v, i));
}

TEST(SampleStrip, IsLinearInterpolationLessTheMean) {
  const cv::Mat image = test::randomImage(20, 90, CV_32F, 3);
  constexpr float kMean = 101.5F;
  for (const int rows : {3, 5, 11})
    for (const int columns : {7, 16, 21})
      for (const double step : {0.8, 0.99, 1.0, 1.02, 1.3})
        for (const double by_row : {-0.6, 0.0, 0.37})
          // Inside the image, and beyond its left and its right side.
          for (const double start : {12.34, -3.5, 79.1}) {
            const StripPlaces places{start, by_row, step};
            const StripSize size{rows, columns, wholeLanes(columns)};
            std::vector<float> strip(size.stride * rows, -1e9F);
            sampleStrip(image, 4, places, size, kMean, strip.data());
            for (int j = 0; j < rows; ++j)
              for (int i = 0; i < columns; ++i) {
                const double expected = valueAt(image, 4 + j, start + by_row * j + step * i) - kMean;
                const float found = strip[j * size.stride + i];
                if (std::isnan(expected)) {
                  ASSERT_TRUE(std::isnan(found)) << start << ' ' << step << ' ' << i << ' ' << j;
                } else {
                  ASSERT_NEAR(found, expected, 2e-3) << start << ' ' << step << ' ' << i << ' ' << j;
                }
              }
          }
}

/// A window of random numbers less its mean, and a strip for some positions.
struct Example {
  int size, count, stride;
  std::vector<float> window, strip;
  double energy = 0;

  Example(int window_size, int positions)
      : size(window_size),
        count(wholeLanes(positions)),
        stride(wholeLanes(count + size - 1)),
        window(test::randomValues<float>(size * size, -60, 60, size)),
        strip(test::randomValues<float>(stride * size, -80, 90, 7 + size)) {
    double sum = 0;
    for (const float value : window) sum += value;
    for (float& value : window) value -= static_cast<float>(sum / (size * size));
    for (const float value : window) energy += static_cast<double>(value) * value;
  }
  CentredWindow centred() const { return {window.data(), size, energy}; }
  double at(int position, int i, int j) const { return strip[j * stride + position + i]; }
};

/// Correlation of the window with what is below it; NaN where that is no number.
double correlationAt(const Example& example, int position) {
  double cross = 0, sum = 0, squares = 0;
  for (int j = 0; j < example.size; ++j)
    for (int i = 0; i < example.size; ++i) {
      const double value = example.at(position, i, j);
      cross += example.window[j * example.size + i] * value;
      sum += value;
      squares += value * value;
    }
  const double other = squares - sum * sum / (example.size * example.size);
  if (other < 1e-3 * example.energy) return kNoScore;
  return cross / std::sqrt(other * example.energy);
}

double likenessAt(const Example& example, int position) {
  double differences = 0;
  for (int j = 0; j < example.size; ++j)
    for (int i = 0; i < example.size; ++i)
      differences += std::pow(example.at(position, i, j) - example.window[j * example.size + i], 2);
  return 1 - differences / (2 * example.energy);
}

TEST(CorrelateAlong, IsTheCorrelationAtEachPosition) {
  for (const int size : {3, 5, 11, 13, 21})
    for (const int positions : {1, 5, 8, 9, 24, 61}) {
      Example example(size, positions);
      // The window itself, darker and with less contrast, at the last position.
      for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i)
          example.strip[j * example.stride + positions - 1 + i] = 0.5F * example.window[j * size + i] - 9;
      StripColumns columns;
      std::vector<float> scores(example.count);
      correlateAlong(example.centred(), example.strip.data(), example.stride, example.count, columns,
                     scores.data());
      for (int k = 0; k < positions; ++k)
        ASSERT_NEAR(scores[k], correlationAt(example, k), 1e-4) << size << ' ' << k;
      EXPECT_NEAR(scores[positions - 1], 1, 1e-4);
    }
}

TEST(CompareAlong, IsOneLessTheSquaredDifferencesAtEachPosition) {
  for (const int size : {3, 5, 11, 13})
    for (const int positions : {1, 8, 19}) {
      const Example example(size, positions);
      StripColumns columns;
      std::vector<float> scores(example.count);
      compareAlong(example.centred(), example.strip.data(), example.stride, example.count, columns,
                   scores.data());
      for (int k = 0; k < positions; ++k)
        ASSERT_NEAR(scores[k], likenessAt(example, k), 1e-4) << size << ' ' << k;
    }
}

TEST(StripScores, AreNoneWithoutContrastOrOutsideTheImage) {
  Example example(5, 24);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 6; ++i) example.strip[j * example.stride + i] = 17;  // flat at positions 0 and 1
    example.strip[j * example.stride + 20] = std::numeric_limits<float>::quiet_NaN();  // at 16 to 20
  }
  StripColumns columns;
  std::vector<float> scores(example.count);
  correlateAlong(example.centred(), example.strip.data(), example.stride, example.count, columns,
                 scores.data());
  for (int k = 0; k < 24; ++k) {
    const bool none = k < 2 || (k >= 16 && k <= 20);
    EXPECT_EQ(scores[k] == kNoScore, none) << k;
  }
  compareAlong(example.centred(), example.strip.data(), example.stride, example.count, columns,
               scores.data());
  for (int k = 0; k < 24; ++k) EXPECT_EQ(scores[k] == kNoScore, k >= 16 && k <= 20) << k;
}

}  // namespace
}  // namespace uav_landing
