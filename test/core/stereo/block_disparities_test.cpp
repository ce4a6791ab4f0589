#include "stereo/block_disparities.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

using test::Exposure;
using test::GroundRenderer;
using test::makePose;
using test::Pose;

/// A rig over textured ground and the blocks of its images.
struct Blocks {
  StereoRig rig = test::makeRig(640, 480, 0.65);
  RigModel model = test::makeModel(rig);
  RigRotation rows = test::levelRows();
  Pose pose = makePose(4, -8, 3);
  BlockDisparities disparities{reduceLevel(model, 1, 4)};
  Eigen::Vector3d truth = pose.down() / pose.height();
  cv::Mat left, right;

  explicit Blocks(const Exposure& exposure)
      : left(GroundRenderer(5).left(rig, pose, exposure)),
        right(GroundRenderer(5).right(rig, pose, exposure)) {
    disparities.choose(left, truth);
  }

  /// The true plane with its disparities off by some pixels.
  Eigen::Vector3d off(double pixels) const { return truth + Eigen::Vector3d(0, 0, pixels / rig.fb()); }
  /// Weighted mean of the disparities' errors, pixels.
  double meanError() const {
    double sum = 0, weights = 0;
    for (const BlockDisparity& found : disparities.disparities()) {
      if (!found.alike) continue;
      const DisparitySample& sample = found.sample;
      const double weight = 1 / (sample.stddev * sample.stddev);
      sum += weight * (sample.disparity - rig.fb() * truth.dot(rig.ray(sample.u, sample.v)));
      weights += weight;
    }
    return sum / weights;
  }
};

TEST(BlockDisparities, AreThoseOfTheGroundWhateverTheWarp) {
  for (const double pixels : {-0.3, 0.0, 0.3}) {
    Blocks blocks({1, 0, 1});
    blocks.disparities.measure(blocks.right, blocks.off(pixels), blocks.rows);
    EXPECT_NEAR(blocks.meanError(), 0, 0.03) << "of " << pixels << " px that the warp is off";
    int lowest = 0;
    for (const BlockDisparity& found : blocks.disparities.disparities())
      lowest = std::max(lowest, static_cast<int>(found.sample.v));
    EXPECT_GT(lowest, 400);
  }
}

TEST(BlockDisparities, AreBeyondDoubtInClearImages) {
  Blocks clear({1, 0, 1}), faint({0.15, 90, 6});
  for (Blocks* blocks : {&clear, &faint})
    blocks->disparities.measure(blocks->right, blocks->truth, blocks->rows);
  EXPECT_GT(clear.disparities.certainShare(), 0.95);
  EXPECT_LT(faint.disparities.certainShare(), 0.3);
}

}  // namespace
}  // namespace uav_landing
