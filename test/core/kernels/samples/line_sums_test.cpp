#include "kernels/samples/line_sums.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/lanes/lanes.h"
#include "support/random_values.h"

namespace uav_landing {
namespace {

/// Samples near a line, filled up to whole lanes with what must not count.
struct Example {
  std::vector<float> along, across, weight;
  int count;

  explicit Example(int n) : count(n) {
    along = test::randomValues<float>(wholeLanes(n), -90, 120, n);
    across = test::randomValues<float>(wholeLanes(n), -1, 1, n + 1);
    weight = test::randomValues<float>(wholeLanes(n), 0, 1, n + 2);
    std::sort(along.begin(), along.begin() + n);
    for (int i = 0; i < n; ++i) across[i] += 0.3F - 0.02F * along[i];
    if (n > 3) weight[2] = 0;
  }
  LineSamples samples() const { return {along.data(), across.data(), weight.data(), count}; }
  double distance(int i, const LineFit& line) const {
    return across[i] - line.offset - line.slope * (static_cast<double>(along[i]) - line.centre);
  }
};

const std::vector<int> kCounts = {2, 3, 7, 8, 9, 12, 15, 16, 160, 313, kMostLineSamples};

TEST(LineSums, FitIsTheWeightedLeastSquares) {
  for (const int count : kCounts) {
    const Example example(count);
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d row(1, example.along[i]);
      A += example.weight[i] * row * row.transpose();
      b += example.weight[i] * row * example.across[i];
    }
    const Eigen::Vector2d wanted = A.inverse() * b;  // at 0, and slope
    const LineFit line = fitLine(example.samples());
    EXPECT_NEAR(line.weight, A(0, 0), 1e-4 * A(0, 0)) << count;
    EXPECT_NEAR(line.centre, A(0, 1) / A(0, 0), 1e-2);
    EXPECT_NEAR(line.spread, A(1, 1) - A(0, 1) * A(0, 1) / A(0, 0), 1e-3 * A(1, 1));
    EXPECT_NEAR(line.slope, wanted[1], 1e-3 * std::abs(wanted[1]) + 1e-5) << count;
    EXPECT_NEAR(line.offset - line.slope * line.centre, wanted[0], 1e-3) << count;
  }
}

TEST(LineSums, DistancesAndWeightsAreOfEachSample) {
  for (const int count : kCounts) {
    const Example example(count);
    const LineFit line{20, 0.1F, -0.015F, 1, 1};
    std::vector<float> distances(wholeLanes(count)), weights(wholeLanes(count)), shares(wholeLanes(count));
    const float mean = measureDistances(example.samples(), line, distances.data());
    constexpr float kInverse = 1 / 0.7F;
    weighByDistance(example.weight.data(), distances.data(), kInverse, count, weights.data());
    weighByShare(distances.data(), 0.4F, count, shares.data());
    double sum = 0;
    for (int i = 0; i < count; ++i) {
      const double off = std::abs(example.distance(i, line)), d = off * kInverse;
      sum += off;
      EXPECT_NEAR(distances[i], off, 1e-5);
      EXPECT_NEAR(weights[i], d < 1 ? example.weight[i] * std::pow(1 - d * d, 2) : 0, 1e-4);
      EXPECT_NEAR(shares[i], std::min(1.0, std::pow(off / 0.4, 2)), 1e-4);
    }
    EXPECT_NEAR(mean, sum / count, 1e-5);
    EXPECT_NEAR(meanOf(distances.data(), count), sum / count, 1e-5);
  }
}

TEST(LineSums, ScatterIsOfNeighbours) {
  for (const int count : kCounts) {
    const Example example(count);
    const LineFit line{20, 0.1F, -0.015F, 1, 1};
    double squares = 0, products = 0, pairs = 0;
    for (int i = 0; i < count; ++i) {
      squares += example.weight[i] * std::pow(example.distance(i, line), 2);
      if (i == 0) continue;
      const double shared = std::sqrt(example.weight[i] * example.weight[i - 1]);
      products += shared * example.distance(i, line) * example.distance(i - 1, line);
      pairs += shared;
    }
    const LineScatter scatter = scatterAbout(example.samples(), line);
    EXPECT_NEAR(scatter.squares, squares, 1e-4 * squares) << count;
    EXPECT_NEAR(scatter.products, products, 1e-4 * squares) << count;
    EXPECT_NEAR(scatter.pairs, pairs, 1e-5 * (pairs + 1)) << count;
  }
}

}  // namespace
}  // namespace uav_landing
