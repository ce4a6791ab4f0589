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
  BlockDisparities clear(pair.level());
  disparities.begin(pair.left, pair.right, pair.truth, pair.rows);
  EXPECT_TRUE(disparities.areFaint());
  EXPECT_FALSE(disparities.haveCommonErrors());
  clear.choose(pair.left, pair.truth);
  clear.measure(pair.right, pair.truth, pair.rows);
  expectSame(disparities.found(), clear.disparities());
  bands.choose(pair.left, pair.truth);
  bands.takeRight(pair.right, pair.rows);
  for (const double off : {0.0, 0.3}) {
    disparities.measure(pair.right, pair.off(off), pair.rows);
    bands.measure(pair.off(off));
    ASSERT_GT(bands.disparities().size(), 20u);
    expectSame(disparities.found(), bands.disparities());
    EXPECT_TRUE(disparities.haveCommonErrors());
  }
  int blocks = 0;
  for (const BlockDisparity& disparity : bands.disparities()) blocks += disparity.blocks;
  EXPECT_EQ(disparities.informative(), blocks);
}

}  // namespace
}  // namespace uav_landing
