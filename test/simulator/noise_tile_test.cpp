#include "simulator/ground/noise_tile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

/// Mean square of tile(x + dx, y + dy) - tile(x, y) over the whole tile.
double difference(const NoiseTile& tile, float dx, float dy) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < NoiseTile::kSize; y += 3) {
    for (int x = 0; x < NoiseTile::kSize; x += 3, ++count) {
      const double step = tile.mean(x + 0.5f + dx, y + 0.5f + dy, 1, 1) - tile.mean(x + 0.5f, y + 0.5f, 1, 1);
      sum += step * step;
    }
  }
  return sum / count;
}

class NoiseTileTest : public testing::TestWithParam<double> {};

TEST_P(NoiseTileTest, LooksTheSameAlongAndAcross) {
  const NoiseTile tile(7, GetParam());
  for (const float step : {1.0f, 2.0f, 4.0f}) {
    const double along = difference(tile, step, 0), across = difference(tile, 0, step);
    EXPECT_NEAR(across / along, 1, 0.05) << step;
    // What has no direction changes by as much along both diagonals.
    EXPECT_NEAR(difference(tile, step, step) / difference(tile, step, -step), 1, 0.05) << step;
  }
}

TEST_P(NoiseTileTest, HasNoMeanAndRepeatsWithoutASeam) {
  const NoiseTile tile(7, GetParam());
  EXPECT_NEAR(tile.mean(256, 256, 512, 512), 0, 1e-4);
  for (const float x : {0.0f, 1.7f, 300.2f}) {
    EXPECT_NEAR(tile.mean(x, 5, 1, 1), tile.mean(x + 512, 5, 1, 1), 1e-3);
    EXPECT_NEAR(tile.mean(5, x, 1, 1), tile.mean(5, x + 512, 1, 1), 1e-3);
    EXPECT_NEAR(tile.mean(x, 5, 1, 1), tile.mean(x - 512, 5 - 512, 1, 1), 1e-3);
  }
}

TEST(NoiseTile, ASteeperSpectrumIsSofter) {
  EXPECT_LT(difference(NoiseTile(7, 1.5), 1, 0), 0.5 * difference(NoiseTile(7, 0.8), 1, 0));
}

INSTANTIATE_TEST_SUITE_P(Slopes, NoiseTileTest, testing::Values(0.8, 1.5));

}  // namespace
}  // namespace uav_landing
