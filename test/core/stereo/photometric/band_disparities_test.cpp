#include "stereo/photometric/band_disparities.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereo/photometric/block_disparities.h"
#include "support/ground_pair.h"

namespace uav_landing {
namespace {

using test::Exposure;
using test::GroundPair;

/// Textured ground close below, which the right camera shows darker.
GroundPair closeBelow(unsigned seed, const Exposure& exposure) {
  GroundPair pair({640, 480}, seed, 1.5, -8, 3);
  pair.ground.grain = 0.04;
  pair.render(exposure, {0.9 * exposure.gain, exposure.offset + 5, exposure.noise});
  return pair;
}

const Exposure kFaint{0.25, 80, 7};

TEST(BandDisparities, FollowAShiftOfFaintTextureFully) {
  constexpr int kPairs = 8;
  for (const double side : {-1.0, 1.0}) {
    double mean = 0;
    for (int i = 0; i < kPairs; ++i) {
      const GroundPair scene = closeBelow(1 + i, kFaint);
      BandDisparities bands(scene.level());
      bands.choose(scene.left, scene.truth);
      bands.takeRight(scene.right, scene.rows);
      bands.measure(scene.off(side * 0.4));
      mean += scene.mean(bands.disparities()).error / kPairs;
    }
    EXPECT_NEAR(mean, 0, 0.03) << side << " of 0.4 px that the warp is off";
  }
}

/// Rows that are off are made level before fine texture is looked at.
TEST(BandDisparities, AreTheSameWithRowsThatAreOffAsTold) {
  constexpr int kPairs = 8;
  double told = 0, untold = 0;
  for (int i = 0; i < kPairs; ++i) {
    GroundPair scene({640, 480}, 50 + i, 1.5, -8, 0);
    scene.ground.line_offset = 2;
    scene.ground.line_width = 0.3;
    scene.ground.bend.x() = 0.4 / scene.rig.fy;
    scene.render(kFaint, kFaint);
    BandDisparities bands(scene.level());
    bands.choose(scene.left, scene.truth);
    const auto tilt = [&] {  // disparities that grow to the right, px over the focal length
      double sum = 0, squares = 0;
      for (const BlockDisparity& found : bands.disparities()) {
        const DisparitySample& sample = found.sample;
        const double x = (sample.u - scene.rig.cx) / scene.rig.fx,
                     weight = 1 / (sample.stddev * sample.stddev);
        sum += weight * x * (sample.disparity - scene.truth.disparity(scene.rig, sample.u, sample.v));
        squares += weight * x * x;
      }
      return sum / squares;
    };
    bands.takeRight(scene.right, scene.rows);
    bands.measure(scene.truth);
    untold += tilt() / kPairs;
    scene.rows.w = scene.ground.bend;
    bands.takeRight(scene.right, scene.rows);
    bands.measure(scene.truth);
    told += tilt() / kPairs;
  }
  EXPECT_GT(std::abs(untold), 0.5) << "these scenes show nothing";
  EXPECT_LT(std::abs(told), 0.2 * std::abs(untold));
}

/// As where images were not taken at the same time.
TEST(BandDisparities, AreNoneWhereTheImagesDifferByMoreThanNoise) {
  const GroundPair scene = closeBelow(8, kFaint), other = closeBelow(9, kFaint),
                   clear = closeBelow(8, {1, 0, 1});
  BandDisparities bands(scene.level());
  bands.choose(scene.left, scene.truth);
  bands.takeRight(scene.right, scene.rows);
  bands.measure(scene.truth);
  EXPECT_TRUE(bands.differByNoise());
  EXPECT_GT(bands.disparities().size(), 50u);
  bands.takeRight(other.right, scene.rows);
  bands.measure(scene.truth);
  EXPECT_FALSE(bands.differByNoise());
  EXPECT_TRUE(bands.disparities().empty());
  bands.choose(clear.left, clear.truth);
  bands.takeRight(clear.right, clear.rows);
  bands.measure(clear.off(4));
  EXPECT_FALSE(bands.differByNoise());
}

TEST(BandDisparities, KnowMoreOfFaintTextureThanBlocksAlone) {
  constexpr int kPairs = 12;
  double by_bands = 0, by_blocks = 0, normalised = 0;
  for (int i = 0; i < kPairs; ++i) {
    const GroundPair scene = closeBelow(100 + i, kFaint);
    BandDisparities bands(scene.level());
    bands.choose(scene.left, scene.truth);
    bands.takeRight(scene.right, scene.rows);
    bands.measure(scene.truth);
    BlockDisparities blocks(scene.level());
    blocks.choose(scene.left, scene.truth);
    blocks.measure(scene.right, scene.truth, scene.rows);
    const GroundPair::Mean mean = scene.mean(bands.disparities());
    by_bands += std::pow(mean.error, 2);
    by_blocks += std::pow(scene.mean(blocks.disparities()).error, 2);
    normalised += std::pow(mean.error / mean.stddev, 2) / kPairs;
  }
  EXPECT_LT(by_bands, 0.7 * by_blocks);
  EXPECT_LT(normalised, 2.2);
}

TEST(BandDisparities, AreNoneWhereThereIsNoGround) {
  const GroundPair scene = closeBelow(10, kFaint);
  BandDisparities bands(scene.level());
  bands.choose(scene.left, PlaneVector({0, 0.3, -0.4}));
  bands.takeRight(scene.right, scene.rows);
  bands.measure(scene.truth);
  EXPECT_TRUE(bands.disparities().empty());
}

}  // namespace
}  // namespace uav_landing
