#include "stereo/band_disparities.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereo/block_disparities.h"
#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

using test::Exposure;
using test::GroundRenderer;
using test::makePose;
using test::Pose;

/// A rig over textured ground close below.
struct Scene {
  StereoRig rig = test::makeRig(640, 480, 0.65);
  RigModel model = test::makeModel(rig);
  RigRotation rows = test::levelRows();
  Pose pose = makePose(1.5, -8, 3);
  Eigen::Vector3d truth = pose.down() / pose.height();
  cv::Mat left, right;

  /// The right camera shows it darker.
  Scene(unsigned seed, const Exposure& exposure) {
    GroundRenderer ground(seed);
    ground.grain = 0.04;
    left = ground.left(rig, pose, exposure);
    right = ground.right(rig, pose, {0.9 * exposure.gain, exposure.offset + 5, exposure.noise});
  }
  StereoLevel level() const { return reduceLevel(model, 1, 4); }
  /// The true plane with its disparities off by some pixels.
  Eigen::Vector3d off(double pixels) const { return truth + Eigen::Vector3d(0, 0, pixels / rig.fb()); }

  struct Mean {
    double error = 0, stddev = 0;  // pixels
  };
  /// Weighted mean of the disparities' errors.
  Mean mean(const std::vector<BlockDisparity>& disparities) const {
    double sum = 0, weights = 0;
    for (const BlockDisparity& found : disparities) {
      if (!found.alike) continue;
      const DisparitySample& sample = found.sample;
      const double weight = 1 / (sample.stddev * sample.stddev);
      sum += weight * (sample.disparity - rig.fb() * truth.dot(rig.ray(sample.u, sample.v)));
      weights += weight;
    }
    return {sum / weights, 1 / std::sqrt(weights)};
  }
};

const Exposure kFaint{0.25, 80, 7};

TEST(BandDisparities, FollowAShiftOfFaintTextureFully) {
  for (const double side : {-1.0, 1.0}) {
    const Scene scene(7, kFaint);
    BandDisparities bands(scene.level());
    bands.choose(scene.left, scene.truth);
    bands.measure(scene.right, scene.off(side * 0.4), scene.rows);
    EXPECT_NEAR(scene.mean(bands.disparities()).error, 0, 0.06) << side << " of 0.4 px that the warp is off";
  }
}

/// As where images were not taken at the same time.
TEST(BandDisparities, AreNoneWhereTheImagesDifferByMoreThanNoise) {
  const Scene scene(8, kFaint), other(9, kFaint), clear(8, {1, 0, 1});
  BandDisparities bands(scene.level());
  bands.choose(scene.left, scene.truth);
  bands.measure(scene.right, scene.truth, scene.rows);
  EXPECT_TRUE(bands.differByNoise());
  EXPECT_GT(bands.disparities().size(), 50u);
  bands.measure(other.right, scene.truth, scene.rows);
  EXPECT_FALSE(bands.differByNoise());
  EXPECT_TRUE(bands.disparities().empty());
  bands.choose(clear.left, clear.truth);
  bands.measure(clear.right, clear.off(4), clear.rows);
  EXPECT_FALSE(bands.differByNoise());
}

TEST(BandDisparities, KnowMoreOfFaintTextureThanBlocksAlone) {
  constexpr int kPairs = 12;
  double by_bands = 0, by_blocks = 0, normalised = 0;
  for (int i = 0; i < kPairs; ++i) {
    const Scene scene(100 + i, kFaint);
    BandDisparities bands(scene.level());
    bands.choose(scene.left, scene.truth);
    bands.measure(scene.right, scene.truth, scene.rows);
    BlockDisparities blocks(scene.level());
    blocks.choose(scene.left, scene.truth);
    blocks.measure(scene.right, scene.truth, scene.rows);
    const Scene::Mean mean = scene.mean(bands.disparities());
    by_bands += std::pow(mean.error, 2);
    by_blocks += std::pow(scene.mean(blocks.disparities()).error, 2);
    normalised += std::pow(mean.error / mean.stddev, 2) / kPairs;
  }
  EXPECT_LT(by_bands, 0.7 * by_blocks);
  EXPECT_LT(normalised, 2.2);
}

TEST(BandDisparities, AreNoneWhereThereIsNoGround) {
  const Scene scene(10, kFaint);
  BandDisparities bands(scene.level());
  bands.choose(scene.left, Eigen::Vector3d(0, 0.3, -0.4));
  bands.measure(scene.right, scene.truth, scene.rows);
  EXPECT_TRUE(bands.disparities().empty());
}

}  // namespace
}  // namespace uav_landing
