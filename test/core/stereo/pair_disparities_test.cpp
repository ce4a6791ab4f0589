#include "stereo/pair_disparities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

using test::Exposure;
using test::GroundRenderer;
using test::makePose;
using test::Pose;

/// A painted line ahead on coarse texture, close below and in noise that hides it.
struct LineInNoise {
  StereoRig rig = test::makeRig(640, 480, 0.65);
  RigModel model = test::makeModel(rig);
  RigRotation rows = test::levelRows();
  Pose pose = makePose(1.2, -8, 0);
  Eigen::Vector3d truth = pose.down() / pose.height();
  cv::Mat left, right;

  LineInNoise() {
    GroundRenderer ground(3);
    ground.grain = 0.04;
    ground.contrast = 4;
    ground.line_offset = 0.01;  // two that are one
    const Exposure exposure{1, 0, 8};
    left = ground.left(rig, pose, exposure);
    right = ground.right(rig, pose, exposure);
  }
  /// Those of the whole images alone.
  std::vector<BlockDisparity> ofWholeImages() const {
    BlockDisparities blocks(reduceLevel(model, 1, 4), 1);
    blocks.choose(left, truth);
    blocks.measure(right, truth, rows);
    return blocks.disparities();
  }
};

bool samePlace(const BlockDisparity& a, const BlockDisparity& b) {
  return a.sample.u == b.sample.u && a.sample.v == b.sample.v;
}

TEST(PairDisparities, LeaveAPaintedLineSharpBesideTextureInNoise) {
  const LineInNoise scene;
  PairDisparities pair(scene.model, 4);
  pair.begin(scene.left, scene.right, scene.truth, scene.rows);
  const std::vector<BlockDisparity> whole = scene.ofWholeImages();
  const auto isWhole = [&](const BlockDisparity& found) {
    return std::any_of(whole.begin(), whole.end(),
                       [&](const auto& other) { return samePlace(found, other); });
  };
  // The line leads to the horizon above the principal point; the texture is everywhere.
  int lines = 0, sharp = 0, textures = 0, halved = 0;
  for (const BlockDisparity& found : pair.found()) {
    if (found.sample.v < 300) continue;
    const bool on_line = std::abs(found.sample.u - scene.rig.cx) < 60;
    (on_line ? lines : textures) += 1;
    (on_line ? sharp : halved) += on_line == isWhole(found);
  }
  EXPECT_GT(lines, 20);
  EXPECT_EQ(sharp, lines);
  EXPECT_GT(textures, 10);
  EXPECT_GT(halved, 0.7 * textures);
}

}  // namespace
}  // namespace uav_landing
