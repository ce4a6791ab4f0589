#include "kernels/image/smoothing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// With a Gaussian of 0.7 px, mirrored at the outermost pixels.
double smoothedAt(const cv::Mat_<double>& image, int u, int v) {
  const auto mirrored = [](int i, int size) { return i < 0 ? -i : i >= size ? 2 * size - 2 - i : i; };
  double sum = 0, weights = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const double weight = std::exp(-(i * i + j * j) / (2 * 0.7 * 0.7));
      sum += weight * image(mirrored(v + j, image.rows), mirrored(u + i, image.cols));
      weights += weight;
    }
  return sum / weights;
}

cv::Mat_<double> meansOf(const cv::Mat& image, int factor) {
  cv::Mat_<double> means(image.rows / factor, image.cols / factor);
  for (int v = 0; v < means.rows; ++v)
    for (int u = 0; u < means.cols; ++u)
      means(v, u) = cv::mean(image(cv::Rect(u * factor, v * factor, factor, factor)))[0];
  return means;
}

void expectRows(const cv::Mat_<double>& source, const cv::Range& rows, const cv::Mat& smoothed) {
  for (int v = 0; v < source.rows; ++v)
    for (int u = 0; u < source.cols; ++u) {
      const bool inside = v >= rows.start && v < rows.end;
      ASSERT_NEAR(smoothed.at<float>(v, u), inside ? smoothedAt(source, u, v) : -1, 1e-3) << u << ' ' << v;
    }
}

TEST(Smooth, IsAGaussianMirroredAtTheBorder) {
  for (const int columns : {2, 7, 8, 33, 101}) {
    const cv::Mat image = test::randomImage(13, columns, CV_8UC1, columns);
    for (const cv::Range& rows : {cv::Range(0, 13), cv::Range(4, 9), cv::Range(12, 13)}) {
      cv::Mat smoothed(image.size(), CV_32F, cv::Scalar(-1));
      smooth(image, rows, smoothed);
      expectRows(image, rows, smoothed);
    }
  }
}

TEST(SmoothReduced, IsTheSameOfMeansOverSquares) {
  for (const int factor : {2, 3, 4, 7})
    for (const int columns : {5 * factor, 16 * factor + 1, 40 * factor - 1}) {
      const cv::Mat image = test::randomImage(9 * factor + factor / 2, columns, CV_8UC1, columns);
      const cv::Mat_<double> means = meansOf(image, factor);
      for (const cv::Range& rows : {cv::Range(0, 9), cv::Range(3, 7)}) {
        cv::Mat smoothed(means.size(), CV_32F, cv::Scalar(-1));
        smoothReduced(image, factor, rows, smoothed);
        expectRows(means, rows, smoothed);
      }
    }
}

}  // namespace
}  // namespace uav_landing
