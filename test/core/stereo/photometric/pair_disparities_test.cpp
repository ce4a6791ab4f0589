#include "stereo/photometric/pair_disparities.h"

#include <gtest/gtest.h>

#include "support/ground_pair.h"

namespace uav_landing {
namespace {

using test::GroundPair;

GroundPair closeBelow(const test::Exposure& exposure) {
  GroundPair pair({320, 240}, 3, 1.2, -8, 0);
  pair.render(exposure, exposure);
  return pair;
}

void expectSame(const std::vector<BlockDisparity>& found, const std::vector<BlockDisparity>& all) {
  size_t next = 0;
  for (const BlockDisparity& disparity : all) {
    if (!disparity.alike) continue;
    ASSERT_LT(next, found.size());
    EXPECT_EQ(found[next].sample.disparity, disparity.sample.disparity);
    EXPECT_EQ(found[next++].sample.stddev, disparity.sample.stddev);
  }
  EXPECT_EQ(next, found.size());
}

TEST(PairDisparities, AreOfBlocksInClearImages) {
  const GroundPair pair = closeBelow({1, 0, 1});
  PairDisparities disparities(pair.model, 4);
  BlockDisparities blocks(pair.level());
  disparities.begin(pair.left, pair.right, pair.truth, pair.rows);
  blocks.choose(pair.left, pair.truth);
  blocks.measure(pair.right, pair.truth, pair.rows);
  ASSERT_GT(blocks.disparities().size(), 50u);
  expectSame(disparities.found(), blocks.disparities());
}

TEST(PairDisparities, AreOfAllTextureWhereItIsHardlyMoreThanNoise) {
  const GroundPair pair = closeBelow({0.2, 90, 8});
  PairDisparities disparities(pair.model, 4);
  BandDisparities bands(pair.level());
  disparities.begin(pair.left, pair.right, pair.truth, pair.rows);
  bands.choose(pair.left, pair.truth);
  for (int i = 0; i < 2; ++i) {
    bands.measure(pair.right, pair.truth, pair.rows);
    ASSERT_GT(bands.disparities().size(), 20u);
    expectSame(disparities.found(), bands.disparities());
    disparities.measure(pair.right, pair.truth, pair.rows);
  }
  int blocks = 0;
  for (const BlockDisparity& disparity : bands.disparities()) blocks += disparity.blocks;
  EXPECT_EQ(disparities.informative(), blocks);
}

}  // namespace
}  // namespace uav_landing
