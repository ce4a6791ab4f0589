#include "kernels/edges/edge_peaks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(SetCentres, RoundsAsCvRoundDoes) {
  const Stations stations{3, 4, 201};
  for (const double slope : {0.0, 0.125, -0.3771, 0.5}) {
    EdgeColumns edges;
    setCentres(stations, 250.5, slope, edges);
    for (int i = 0; i < stations.count; ++i)
      ASSERT_EQ(edges.centre[i], cvRound(250.5 + slope * (3 + 4 * i))) << slope << ' ' << i;
  }
}

/// Where the gradient times sign is largest within reach, the first of equals; none at the end or if it is
/// weak.
std::optional<int> strongest(const uchar* pixel, int reach, int sign, int least) {
  const auto twice = [&](int k) { return sign * (pixel[k + 1] - pixel[k - 1]); };
  int place = -reach - 1;
  for (int k = place; k <= reach + 1; ++k)
    if (twice(k) > twice(place)) place = k;
  if (std::abs(place) > reach || twice(place) < least) return std::nullopt;
  return place;
}

TEST(FindEdges, AreTheStrongestGradientsNearTheCentres) {
  const cv::Mat image = test::randomImage(64, 64, CV_8UC1, 3);
  const cv::Mat coarse = (image / 32) * 32;  // equal gradients
  const std::vector<uchar> nothing(16, 0);
  for (const cv::Mat& picture : {image, coarse})
    for (const int reach : {1, 2})
      for (const short sign : {1, -1})
        for (const short least : {1, 96}) {
          std::vector<const uchar*> pixels;
          for (int i = 0; i < 61; ++i)
            pixels.push_back(i % 9 == 4 ? &nothing[8] : picture.ptr<uchar>(i) + 5 + (i * 7) % 50);
          const int count = static_cast<int>(pixels.size());
          while (pixels.size() % EdgeColumns::kAtOnce != 0) pixels.push_back(&nothing[8]);
          EdgeColumns edges;
          findEdges(pixels.data(), count, reach, sign, least, edges);
          int found = 0;
          for (int i = 0; i < count; ++i) {
            const std::optional<int> place = strongest(pixels[i], reach, sign, least);
            ASSERT_EQ(edges.found[i], place ? 1 : 0) << i << ' ' << reach << ' ' << sign;
            if (!place) continue;
            ++found;
            const auto twice = [&](int k) { return sign * (pixels[i][k + 1] - pixels[i][k - 1]); };
            EXPECT_EQ(edges.place[i], *place);
            EXPECT_EQ(edges.twice[i], twice(*place));
            EXPECT_EQ(edges.before[i], twice(*place - 1));
            EXPECT_EQ(edges.after[i], twice(*place + 1));
          }
          EXPECT_GT(found, 5);
        }
}

TEST(FindPeaks, AreOnParabolasAlongAndAcrossTheLine) {
  // Axes of a line that leans by 0.3 rad; the line's gradient is larger than that along a station.
  const double c = std::cos(0.3), s = std::sin(0.3);
  const LineAxes axes{40, 25, c, s, -s, c, 0.5 / c};
  const Stations stations{10, 3, 29};
  EdgeColumns edges;
  for (int i = 0; i < 32; ++i) {
    edges.centre[i] = 20 + i;
    edges.place[i] = static_cast<short>(i % 3 - 1);
    edges.twice[i] = static_cast<short>(60 + i);
    edges.before[i] = static_cast<short>(20 + 2 * i % 17);
    edges.after[i] = static_cast<short>(30 - i % 5);
    edges.found[i] = static_cast<short>(i % 4 == 0 ? 0 : 1);
  }
  std::vector<float> along(32), across(32), gradient(32);
  findPeaks(edges, stations, axes, along.data(), across.data(), gradient.data());
  std::vector<float> wanted_along, wanted_across, wanted_gradient;
  for (int i = 0; i < stations.count; ++i) {
    // The vertex of the parabola through three gradients.
    const double before = edges.before[i], twice = edges.twice[i], after = edges.after[i];
    const double curvature = before - 2 * twice + after, slope = 0.5 * (after - before);
    const double major = 10 + 3 * i - 40, minor = 20 + i + (i % 3 - 1) - slope / curvature - 25;
    EXPECT_NEAR(along[i], c * major + s * minor, 1e-4);
    EXPECT_NEAR(across[i], -s * major + c * minor, 1e-4);
    EXPECT_NEAR(gradient[i], 0.5 / c * twice, 1e-4);
    if (i % 4 == 0) continue;
    wanted_along.push_back(along[i]);
    wanted_across.push_back(across[i]);
    wanted_gradient.push_back(gradient[i]);
  }
  const int kept = keepFound(edges, stations.count, along.data(), across.data(), gradient.data());
  ASSERT_EQ(kept, static_cast<int>(wanted_along.size()));
  for (int i = 0; i < kept; ++i) {
    EXPECT_EQ(along[i], wanted_along[i]);
    EXPECT_EQ(across[i], wanted_across[i]);
    EXPECT_EQ(gradient[i], wanted_gradient[i]);
  }
}

}  // namespace
}  // namespace uav_landing
