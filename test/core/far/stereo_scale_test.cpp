#include "far/stereo_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing {
namespace {

constexpr double kFocal = 554, kWidth = 40, kInterval = 0.1;  // px, m, s

/// A runway that comes nearer, 6 m from pair to pair.
struct Seen {
  double disparity, width;  // px
};
Seen seenAt(int pair) {
  const double depth = 1500 - 6.0 * pair;
  return {kFocal / depth, kFocal * kWidth / depth};
}

TEST(StereoScale, IsAveragedOverPairsWhileTheRunwayComesNearer) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.04);
  double squares = 0, claimed = 0;
  constexpr int kFlights = 200;
  for (int flight = 0; flight < kFlights; ++flight) {
    StereoScale scale;
    SurfaceDisparity found;
    for (int i = 0; i < 60; ++i) {
      const Seen seen = seenAt(i);
      found = scale.follow(kInterval, {{320, 240}, seen.disparity + noise(random), 0.04 * 0.04}, seen.width);
    }
    squares += std::pow(found.value - seenAt(59).disparity, 2) / kFlights;
    claimed += found.variance / kFlights;
  }
  EXPECT_LT(std::sqrt(squares), 0.04 / 3);
  // Old pairs count less than they could, which the claim does not know.
  EXPECT_GT(std::sqrt(squares / claimed), 0.6);
  EXPECT_LT(std::sqrt(squares / claimed), 1.1);
}

TEST(StereoScale, ABiasDoesNotAverageOut) {
  StereoScale scale;
  SurfaceDisparity found;
  for (int i = 0; i < 100; ++i) {
    const Seen seen = seenAt(i);
    found = scale.follow(kInterval, {{320, 240}, seen.disparity + 0.02, 1e-4, 0.02}, seen.width);
  }
  const double error = found.value - seenAt(99).disparity;
  EXPECT_NEAR(found.bias_stddev, error, 0.05 * error);
  EXPECT_GT(error, 0.02) << "it weighs more from afar";
  EXPECT_LT(found.variance, 0.2 * 1e-4);
  EXPECT_DOUBLE_EQ(found.totalVariance(), found.variance + found.bias_stddev * found.bias_stddev);
}

TEST(StereoScale, BeginsAnewWithAnotherEdge) {
  StereoScale scale;
  for (int i = 0; i < 30; ++i)
    scale.follow(kInterval, {{320, 240}, seenAt(i).disparity, 1e-4}, seenAt(i).width);
  const Seen seen = seenAt(30);
  const SurfaceDisparity found =
      scale.follow(kInterval, {{320, 240}, seen.disparity, 1e-4}, 0.85 * seen.width);
  EXPECT_DOUBLE_EQ(found.value, seen.disparity);
  EXPECT_DOUBLE_EQ(found.variance, 1e-4);
}

}  // namespace
}  // namespace uav_landing
