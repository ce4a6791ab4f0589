#include "kernels/image/line_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// Bilinear, from the four pixels around the place that a pinhole camera has; NaN where there are none.
double expectedGrey(const LineView& line, double y, const cv::Mat& image, const cv::Mat& mask) {
  const Eigen::Vector3d point = line.origin + y * line.direction;
  if (!(point.z() > 0)) return NAN;
  const double u = line.fx * point.x() / point.z() + line.cx, v = line.fy * point.y() / point.z() + line.cy;
  if (!(u > 0 && v > 0 && u < image.cols - 1 && v < image.rows - 1)) return NAN;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  if (mask.at<uchar>(j, i) == 0) return NAN;
  const double s = u - i, t = v - j;
  const auto at = [&](int x, int y) { return static_cast<double>(image.at<uchar>(y, x)); };
  return (1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j)) +
         t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1));
}

void expectAsSeen(const LineView& line, double reach) {
  const cv::Mat image = test::randomImage(60, 81, CV_8UC1, 5);
  cv::Mat mask(image.size(), CV_8UC1, cv::Scalar(255));
  mask(cv::Rect(20, 0, 9, 60)).setTo(0);
  LinePlaces y;
  for (int c = 0; c < kLineSamples; ++c) y[c] = reach * (2.0 * c / (kLineSamples - 1) - 1);
  LineGreys greys;
  const int count = sampleLine(line, y, image, mask, greys);
  int expected_count = 0;
  for (int c = 0; c < kLineSamples; ++c) {
    const double expected = expectedGrey(line, y[c], image, mask);
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(greys[c])) << c;
    } else {
      EXPECT_NEAR(greys[c], expected, 1e-2) << c;
      ++expected_count;
    }
  }
  EXPECT_EQ(count, expected_count);
}

TEST(SampleLine, IsWhatThePictureShowsOfIt) {
  const Eigen::Vector3d along(-1, 0.1, 0.05);
  expectAsSeen({{0.1, 0.4, 2}, along, 70, 72, 40.3, 29.6},
               0.9);  // all inside, but for what the mask leaves out
  expectAsSeen({{0.1, 0.4, 2}, along, 70, 72, 40.3, 29.6}, 4);             // beyond both sides
  expectAsSeen({{0.1, 0.4, 0.2}, {-0.2, 0.1, 1}, 70, 72, 40.3, 29.6}, 2);  // from behind the camera
  expectAsSeen({{0.1, 0.4, 2}, {0, -1, 0}, 70, 72, 40.3, 29.6}, 3);        // above and below
}

TEST(AverageLines, IsTheMeanOfEachSample) {
  for (const int count : {1, 2, 7}) {
    std::vector<LineGreys> lines(count);
    for (int i = 0; i < count; ++i) {
      const std::vector<float> values = test::randomValues<float>(kLineSamples, 0, 255, 10 + i);
      std::copy(values.begin(), values.end(), lines[i].begin());
    }
    lines[0][5] = NAN;
    LineGreys mean;
    averageLines(lines.data(), count, mean);
    for (int c = 0; c < kLineSamples; ++c) {
      double sum = 0;
      for (const LineGreys& line : lines) sum += line[c];
      if (c == 5) {
        EXPECT_TRUE(std::isnan(mean[c]));
      } else {
        EXPECT_NEAR(mean[c], sum / count, 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace uav_landing
