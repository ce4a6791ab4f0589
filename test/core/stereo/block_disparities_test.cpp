#include "stereo/block_disparities.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

using test::Exposure;
using test::GroundRenderer;
using test::makePose;
using test::Pose;

/// A rig over textured ground and the blocks of its images, reduced by a factor.
struct Blocks {
  StereoRig rig = test::makeRig(640, 480, 0.65);
  RigModel model = test::makeModel(rig);
  RigRotation rows = test::levelRows();
  Pose pose;
  BlockDisparities disparities;
  Eigen::Vector3d truth;
  cv::Mat left, right;

  Blocks(int factor, double height, const Exposure& exposure, unsigned seed = 5)
      : pose(makePose(height, -8, 3)),
        disparities(reduceLevel(model, factor, 4), factor),
        truth(pose.down() / pose.height()),
        left(reduced(GroundRenderer(seed).left(rig, pose, exposure), factor)),
        right(reduced(GroundRenderer(seed).right(rig, pose, exposure), factor)) {
    disparities.choose(left, truth);
  }

  /// The true plane with its disparities off by some pixels of the whole images.
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

  static cv::Mat reduced(const cv::Mat& image, int factor) {
    cv::Mat small;
    cv::resize(image, small, image.size() / factor, 0, 0, cv::INTER_AREA);
    return small;
  }
};

TEST(BlockDisparities, AreInPixelsOfTheWholeImagesAtEveryFactor) {
  for (const int factor : {1, 2, 4}) {
    Blocks blocks(factor, 4, {1, 0, 1});
    blocks.disparities.measure(blocks.right, blocks.off(0.3), blocks.rows);
    EXPECT_NEAR(blocks.meanError(), 0, 0.03) << factor << ", of 0.3 px that the warp is off";
    int lowest = 0;
    for (const BlockDisparity& found : blocks.disparities.disparities())
      lowest = std::max(lowest, static_cast<int>(found.sample.v));
    EXPECT_GT(lowest, 190) << factor;
  }
}

TEST(BlockDisparities, AreBeyondDoubtInClearImages) {
  Blocks clear(1, 4, {1, 0, 1}), faint(1, 4, {0.15, 90, 6});
  for (Blocks* blocks : {&clear, &faint})
    blocks->disparities.measure(blocks->right, blocks->truth, blocks->rows);
  EXPECT_GT(clear.disparities.certainShare(), 0.95);
  EXPECT_LT(faint.disparities.certainShare(), 0.3);
}

/// Noise makes a block's gradients larger than what a shift shows of them.
TEST(BlockDisparities, FollowAShiftMoreFullyOnceTheirResponseIsMeasured) {
  constexpr int kPairs = 8;
  constexpr double kOff = 0.4;  // pixels
  for (const double side : {-1.0, 1.0}) {
    double before = 0, after = 0;
    for (int i = 0; i < kPairs; ++i) {
      Blocks blocks(1, 1.5, {0.25, 80, 7}, 300 + i);
      blocks.disparities.measure(blocks.right, blocks.off(side * kOff), blocks.rows);
      before += side * blocks.meanError() / kPairs;
      blocks.disparities.measureResponse(blocks.right, blocks.off(side * kOff), blocks.rows);
      after += side * blocks.meanError() / kPairs;
    }
    EXPECT_GT(before, 0.2 * kOff) << "these images have gradients that show the shift";
    EXPECT_LT(std::abs(after), 0.6 * before) << side;
  }
}

TEST(BlockDisparities, SayNothingWhereTheyDoNotShowAShift) {
  Blocks blocks(1, 4, {1, 0, 1});
  cv::Mat noise(blocks.right.size(), CV_8U);
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 90, 6);
  cv::RNG(8).fill(blocks.left, cv::RNG::NORMAL, 90, 6);
  blocks.disparities.choose(blocks.left, blocks.truth);
  blocks.disparities.measure(noise, blocks.truth, blocks.rows);
  blocks.disparities.measureResponse(noise, blocks.truth, blocks.rows);
  for (const BlockDisparity& found : blocks.disparities.disparities())
    EXPECT_LT(found.sample.stddev, 0.5) << "only blocks that are certain by chance";
  EXPECT_LT(blocks.disparities.disparities().size(), 20u);
}

}  // namespace
}  // namespace uav_landing
