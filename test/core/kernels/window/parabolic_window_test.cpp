#include "kernels/window/parabolic_window.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

namespace uav_landing {
namespace {

/// Piecewise parabolic interpolation is exact for polynomials of the second degree.
double polynomial(double x, double y) {
  return 3 + 0.5 * x - 0.8 * y + 0.04 * x * x - 0.03 * x * y + 0.05 * y * y;
}

cv::Mat polynomialImage() {
  cv::Mat image(40, 50, CV_32F);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) image.at<float>(v, u) = static_cast<float>(polynomial(u, v));
  return image;
}

// The table rounds places to 1/256 pixel, so by up to 0.002; slopes are below 5 a pixel in either direction.
constexpr double kTolerance = 2 * 5 * 0.5 / 256;

// By hand: at 1/4 the parabola through the first three samples has the weights -3/32, 30/32, 5/32, the one
// through the last three 21/32, 14/32, -3/32.
TEST(ParabolicTable, HasTheMeanOfBothParabolas) {
  const auto expect = [](double fraction, const std::array<double, 4>& wanted) {
    const float* weights = ParabolicTable::get().at(ParabolicTable::fixed(fraction));
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(weights[k], wanted[k], 1e-6) << fraction << ' ' << k;
  };
  expect(0, {0, 1, 0, 0});
  expect(0.5, {-1.0 / 16, 9.0 / 16, 9.0 / 16, -1.0 / 16});
  expect(0.25, {-3.0 / 64, 51.0 / 64, 19.0 / 64, -3.0 / 64});
  // The nearest of the table's places, not the one before.
  expect(0.25 - 0.4 / 256, {-3.0 / 64, 51.0 / 64, 19.0 / 64, -3.0 / 64});
}

// Where a wave seems to be is its phase over its frequency.
TEST(ParabolicTable, ShowsTextureWhereItIs) {
  for (const double period : {4.0, 5.0, 6.0, 8.0, 12.0, 30.0}) {
    const double frequency = 2 * M_PI / period;
    for (int i = 0; i <= 64; ++i) {
      const double fraction = i / 64.0;
      const float* weights = ParabolicTable::get().at(ParabolicTable::fixed(fraction));
      std::complex<double> seen = 0;
      for (int k = 0; k < 4; ++k)
        seen += static_cast<double>(weights[k]) * std::polar(1.0, frequency * (k - 1 - fraction));
      EXPECT_NEAR(std::arg(seen) / frequency, 0, 0.0045) << period << ' ' << fraction;
    }
  }
}

TEST(SampleParabolicLine, IsExactForParabolasInAnyDirection) {
  const cv::Mat image = polynomialImage();
  for (const double step_x : {-0.7, 0.6, 1.0, 1.37})
    for (const double step_y : {-0.45, 0.0, 0.3}) {
      const double x = step_x > 0 ? 10.31 : 30.31, y = 19.77;
      std::vector<float> out(12, -1e9F);
      sampleParabolicLine(image, ParabolicTable::fixed(x), ParabolicTable::fixed(y),
                          ParabolicTable::fixed(step_x), ParabolicTable::fixed(step_y), 12, out.data());
      for (int i = 0; i < 12; ++i)
        EXPECT_NEAR(out[i], polynomial(x + i * step_x, y + i * step_y), kTolerance) << step_x << ' ' << i;
    }
}

TEST(SampleParabolicRow, IsExactForParabolas) {
  const cv::Mat image = polynomialImage();
  for (const double step : {-0.7, 0.6, 1.0, 1.37}) {
    const double x = step > 0 ? 10.31 : 30.31;
    std::vector<float> out(12, -1e9F);
    sampleParabolicRow(image.ptr<float>(23), ParabolicTable::fixed(x), ParabolicTable::fixed(step), 12,
                       out.data());
    for (int i = 0; i < 12; ++i)
      EXPECT_NEAR(out[i], polynomial(x + i * step, 23), kTolerance) << step << ' ' << i;
  }
}

TEST(SampleParabolic, WritesWholeBlocksOfFour) {
  const cv::Mat image = polynomialImage();
  std::vector<float> line(12, -1e9F), row(12, -1e9F);
  const auto fixed = [](double x) { return ParabolicTable::fixed(x); };
  sampleParabolicLine(image, fixed(10), fixed(9), fixed(1), 0, 5, line.data());
  sampleParabolicRow(image.ptr<float>(9), fixed(10), fixed(1), 5, row.data());
  for (int i = 0; i < 12; ++i) {
    EXPECT_FLOAT_EQ(line[i], i < 8 ? image.at<float>(9, 10 + i) : -1e9F);
    EXPECT_FLOAT_EQ(row[i], i < 8 ? image.at<float>(9, 10 + i) : -1e9F);
  }
}

TEST(SampleParabolicRows, IsExactForParabolasNearAndFarFromTheBorder) {
  const cv::Mat image = polynomialImage();
  for (const double step : {0.7, 0.95, 1.0, 1.06, 1.4})
    for (const double start : {1.5, 12.3, 30.0})
      for (const double by_row : {-0.1, 0.3}) {
        if (start + 4 * by_row + 11 * step + 2 >= image.cols) continue;
        std::vector<float> out(5 * 12 + 8, -1e9F);
        sampleParabolicRows(image, 20, start, by_row, step, 5, 12, out.data());
        for (int j = 0; j < 5; ++j)
          for (int i = 0; i < 12; ++i)
            EXPECT_NEAR(out[j * 12 + i], polynomial(start + j * by_row + i * step, 20 + j), kTolerance)
                << step << ' ' << start << ' ' << by_row << ' ' << j << ' ' << i;
      }
}

/// Mean of the parabolas through the values at -1, 0, 1 and at 0, 1, 2, by Newton's divided differences.
double meanOfParabolas(double a, double b, double c, double d, double t) {
  const double first = a + (t + 1) * (b - a) + (t + 1) * t * (c - 2 * b + a) / 2;
  const double second = b + t * (c - b) + t * (t - 1) * (d - 2 * c + b) / 2;
  return (first + second) / 2;
}

// Where texture is finer than parabolas, with steps for which vectors of neighbours are read and others.
TEST(SampleParabolicRows, IsTheMeanOfBothParabolas) {
  cv::Mat image(40, 60, CV_32F);
  cv::RNG(5).fill(image, cv::RNG::UNIFORM, 0, 255);
  // By the rounding of the table's places, at up to 255 grey levels a pixel; of floats where there is none.
  for (const auto& [step, tolerance] : {std::pair(1.0, 0.01), std::pair(1.03, 0.01), std::pair(1.4, 2.0)}) {
    std::vector<float> out(5 * 12 + 8);
    sampleParabolicRows(image, 20, 10.37, 0.21, step, 5, 12, out.data());
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 12; ++i) {
        const double x = 10.37 + 0.21 * j + i * step;
        const int whole = static_cast<int>(x);
        const float* p = image.ptr<float>(20 + j) + whole;
        EXPECT_NEAR(out[j * 12 + i], meanOfParabolas(p[-1], p[0], p[1], p[2], x - whole), tolerance)
            << step << ' ' << i << ' ' << j;
      }
  }
}

/// The image at a place of a line that has this slope: down all columns that it crosses, then along it.
double acrossColumnsAndAlong(const cv::Mat& image, const Eigen::Vector2d& start, double slope, double x) {
  const int whole = static_cast<int>(x);
  std::array<double, 4> crossings;
  for (int k = 0; k < 4; ++k) {
    const int column = whole - 1 + k;
    const double y = start.y() + slope * (column - start.x());
    const int top = static_cast<int>(y);
    const auto grey = [&](int row) { return image.at<float>(row, column); };
    crossings[k] = meanOfParabolas(grey(top - 1), grey(top), grey(top + 1), grey(top + 2), y - top);
  }
  return meanOfParabolas(crossings[0], crossings[1], crossings[2], crossings[3], x - whole);
}

// Places that a table would have to round are where they are: of the column in all windows, and also along
// the line where its steps are near a pixel. Otherwise they are multiples of 1/256 here.
TEST(SampleParabolicWindow, IsTheMeanOfBothParabolasAcrossColumnsAndAlongTheLine) {
  cv::Mat image(60, 70, CV_32F);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, 255);
  constexpr int kRadius = 5, kStride = 12;
  for (const double step : {0.95, 1.0, 1.03, 1.25})
    for (const double slope : {-0.04, 0.0, 0.03})
      for (const double shear : {-0.25, 0.0, 0.25}) {
        Eigen::Matrix2d warp;
        warp << step, shear, slope * step, 1.07;
        const Eigen::Vector2d at(31.25, 27.3713);
        std::vector<float> out(kStride * (2 * kRadius + 1) + 8);
        sampleParabolicWindow(image, at, warp, kRadius, kStride, out.data());
        for (int j = 0; j <= 2 * kRadius; ++j)
          for (int i = 0; i <= 2 * kRadius; ++i) {
            const Eigen::Vector2d start = at + warp * Eigen::Vector2d(-kRadius, j - kRadius);
            EXPECT_NEAR(out[j * kStride + i],
                        acrossColumnsAndAlong(image, start, slope, start.x() + i * step), 0.02)
                << step << ' ' << slope << ' ' << shear << ' ' << i << ' ' << j;
          }
      }
}

/// Leaves numbers behind that would be seen in everything that reads memory it never wrote.
__attribute__((noinline)) float spoilStack() {
  volatile float left_over[20000];
  for (volatile float& value : left_over) value = NAN;
  return left_over[7];
}

TEST(SampleParabolicWindow, ReadsNothingThatIsNotTheImage) {
  const cv::Mat image = polynomialImage();
  const int radius = 5, stride = 12;
  for (const double step : {0.95, 0.993, 1.0, 1.007, 1.05})
    for (double x = 20; x < 21; x += 0.06) {
      const Eigen::Matrix2d warp = Eigen::Vector2d(step, 1).asDiagonal();
      std::vector<float> out(stride * (2 * radius + 1) + 8);
      EXPECT_TRUE(std::isnan(spoilStack()));
      sampleParabolicWindow(image, {x, 20.3}, warp, radius, stride, out.data());
      for (int j = 0; j <= 2 * radius; ++j)
        for (int i = 0; i <= 2 * radius; ++i)
          EXPECT_NEAR(out[j * stride + i], polynomial(x + (i - radius) * step, 20.3 + j - radius), kTolerance)
              << step << ' ' << x << ' ' << i << ' ' << j;
    }
}

}  // namespace
}  // namespace uav_landing
