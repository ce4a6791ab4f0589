#include "stereo/pair_disparities.h"

#include <gtest/gtest.h>

#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

using test::Exposure;
using test::GroundRenderer;
using test::makePose;
using test::Pose;

struct Pair {
  StereoRig rig = test::makeRig(320, 240, 0.65);
  RigModel model = test::makeModel(rig);
  RigRotation rows = test::levelRows();
  Pose pose = makePose(1.2, -8, 0);
  Eigen::Vector3d truth = pose.down() / pose.height();
  cv::Mat left, right;

  explicit Pair(const Exposure& exposure)
      : left(GroundRenderer(3).left(rig, pose, exposure)),
        right(GroundRenderer(3).right(rig, pose, exposure)) {}
};

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
  const Pair pair({1, 0, 1});
  PairDisparities disparities(pair.model, 4);
  BlockDisparities blocks(reduceLevel(pair.model, 1, 4));
  disparities.begin(pair.left, pair.right, pair.truth, pair.rows);
  blocks.choose(pair.left, pair.truth);
  blocks.measure(pair.right, pair.truth, pair.rows);
  ASSERT_GT(blocks.disparities().size(), 50u);
  expectSame(disparities.found(), blocks.disparities());
}

TEST(PairDisparities, AreOfAllTextureWhereItIsHardlyMoreThanNoise) {
  const Pair pair({0.2, 90, 8});
  PairDisparities disparities(pair.model, 4);
  BandDisparities bands(reduceLevel(pair.model, 1, 4));
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
