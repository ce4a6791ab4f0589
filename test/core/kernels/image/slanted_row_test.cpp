#include "kernels/image/slanted_row.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// Mean of the parabolas through the values at -1, 0, 1 and at 0, 1, 2, by Lagrange's weights.
double meanOfParabolas(const std::array<double, 4>& p, double t) {
  const double first = p[0] * t * (t - 1) / 2 - p[1] * (t + 1) * (t - 1) + p[2] * (t + 1) * t / 2;
  const double second = p[1] * (t - 1) * (t - 2) / 2 - p[2] * t * (t - 2) + p[3] * t * (t - 1) / 2;
  return (first + second) / 2;
}

TEST(SampleSlantedRow, IsInterpolatedDownEachColumn) {
  for (const int columns : {1, 31, 32, 33, 90}) {
    const cv::Mat image = test::randomImage(40, columns, CV_32F, columns);
    for (const double slope : {-0.2, -0.003, 0.0, 0.001, 0.3})
      for (const double first : {-3.0, 0.4, 1.0, 17.63, 36.5, 39.0}) {
        std::vector<float> out(columns);
        sampleSlantedRow(image, {first, slope}, out.data());
        for (int u = 0; u < columns; ++u) {
          const double place = std::clamp(first + slope * u, 1.0, image.rows - 2.001);
          const int whole = static_cast<int>(place);
          std::array<double, 4> around;
          for (int k = 0; k < 4; ++k) around[k] = image.at<float>(whole - 1 + k, u);
          ASSERT_NEAR(out[u], meanOfParabolas(around, place - whole), 2e-3)
              << first << ' ' << slope << ' ' << u;
        }
      }
  }
}

}  // namespace
}  // namespace uav_landing
