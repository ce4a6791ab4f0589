#include "kernels/edges/edge_growth.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// Stations found by looking at them one by one, as the header has it.
struct Followed {
  std::vector<Eigen::Vector2d> stations{{0, 0}};  // row and column from the seed
  int from = 0, to = 0, looked = 1;
};

/// Line through the stations by least squares, with ten stations' worth of the slope expected.
Straight fitted(const std::vector<Eigen::Vector2d>& stations, double slope) {
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  A(1, 1) = 10;
  b[1] = 10 * slope;
  for (const Eigen::Vector2d& station : stations) {
    const Eigen::Vector2d row(1, station[0]);
    A += row * row.transpose();
    b += row * station[1];
  }
  const Eigen::Vector2d x = A.inverse() * b;
  return {x[0], x[1]};
}

/// Column of the strongest brightness step within a pixel of a place: the middle one of equals, then the one
/// before.
std::optional<int> strongestStep(const cv::Mat& image, int v, int middle, int sign, int least) {
  if (middle < 3 || middle + 4 >= image.cols) return std::nullopt;
  const auto step = [&](int u) {
    int sum = 0;
    for (const int k : {-1, 0, 0, 1}) sum += image.at<uchar>(v + k, u + 1) - image.at<uchar>(v + k, u - 1);
    return sign * sum;
  };
  int best = middle;
  for (const int u : {middle - 1, middle + 1})
    if (step(u) > step(best)) best = u;
  if (step(best) < least) return std::nullopt;
  return best;
}

Followed follow(const cv::Mat& image, const cv::Mat& mask, const Seed& seed, const GrowthLimits& limits) {
  Followed edge;
  struct Side {
    int step, most, end = 0, misses = 0;
    bool open = true;
  };
  Side sides[] = {{1, image.rows - 2 - seed.v}, {-1, seed.v - 1}};
  Straight line{0, seed.slope};
  for (int distance = 1, skip = 1; sides[0].open || sides[1].open; distance += skip) {
    if (distance > 8) skip = 2;
    for (Side& side : sides) {
      if (!side.open) continue;
      const int station = side.step * distance, v = seed.v + station;
      ++edge.looked;
      const double expected = seed.u + line.at(station);
      std::optional<int> found;
      if (distance <= side.most && expected >= 3)
        found = strongestStep(image, v, static_cast<int>(expected + 0.5), seed.sign, limits.least);
      if (found && mask.at<uchar>(v, *found) != 0 && std::abs(*found - expected) < 1.25) {
        edge.stations.emplace_back(station, *found - seed.u);
        side.end = station;
        side.misses = 0;
      } else if (++side.misses * skip > limits.max_gap) {
        side.open = false;
        edge.looked -= side.misses;
      }
    }
    line = fitted(edge.stations, seed.slope);
    if (distance == 3 && static_cast<double>(edge.stations.size()) < 0.8 * edge.looked) break;
  }
  edge.to = sides[0].end;
  edge.from = sides[1].end;
  return edge;
}

/// Noise, with a brighter part to the right of a line u = offset + slope v.
cv::Mat picture(double offset, double slope, double noise, unsigned seed) {
  cv::Mat image(70, 90, CV_8UC1);
  cv::Mat noisy(image.size(), CV_32F);
  cv::RNG random(seed);
  random.fill(noisy, cv::RNG::NORMAL, 0, noise);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) {
      const double share = std::clamp(u - offset - slope * v + 0.5, 0.0, 1.0);
      image.at<uchar>(v, u) = cv::saturate_cast<uchar>(80 + 60 * share + noisy.at<float>(v, u));
    }
  return image;
}

TEST(GrowEdge, FollowsTheStrongestStepsFromItsSeed) {
  int shown = 0, texture = 0;
  for (const double slope : {-0.6, -0.1, 0.0, 0.35, 1.0})
    for (const double noise : {0.0, 6.0, 30.0, 80.0})
      for (unsigned seed = 1; seed < 5; ++seed) {
        const cv::Mat image = picture(30.2 - 20 * (slope - 0.3), slope, noise, seed);
        cv::Mat mask(image.size(), CV_8UC1, cv::Scalar(255));
        mask.rowRange(50, 53).setTo(0);
        const Seed start{cvRound(30.2 - 20 * (slope - 0.3) + slope * 35), 35, 1, slope + 0.03};
        const GrowthLimits limits{60, 5};
        const Followed wanted = follow(image, mask, start, limits);
        const GrownEdge edge =
            growEdge({image.ptr<uchar>(), static_cast<std::ptrdiff_t>(image.step), image.cols, image.rows},
                     EdgeMask(mask, false), start, limits);
        EXPECT_EQ(edge.from, wanted.from) << slope << ' ' << noise << ' ' << seed;
        EXPECT_EQ(edge.to, wanted.to) << slope << ' ' << noise << ' ' << seed;
        EXPECT_EQ(edge.looked, wanted.looked);
        ASSERT_EQ(edge.line.count(), wanted.stations.size());
        const Straight line = fitted(wanted.stations, start.slope);
        EXPECT_NEAR(edge.line.slope(), line.slope, 1e-9);
        EXPECT_NEAR(edge.line.at(0), line.offset, 1e-9);
        (edge.isShown() ? shown : texture) += 1;
      }
  EXPECT_GT(shown, 20);
  EXPECT_GT(texture, 3);
}

TEST(EdgeMask, MayBeOfATransposedImage) {
  const cv::Mat mask = test::randomImage(9, 14, CV_8UC1, 3) > 128;
  for (int v = 0; v < mask.rows; ++v)
    for (int u = 0; u < mask.cols; ++u) {
      EXPECT_EQ(EdgeMask(mask, false).has(u, v), mask.at<uchar>(v, u) != 0);
      EXPECT_EQ(EdgeMask(mask, true).has(v, u), mask.at<uchar>(v, u) != 0);
    }
}

}  // namespace
}  // namespace uav_landing
