#include "stereo/photometric/block_disparities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <vector>

#include "support/ground_pair.h"

namespace uav_landing {
namespace {

/// The blocks of a pair's images.
struct Blocks : test::GroundPair {
  BlockDisparities disparities{level()};

  explicit Blocks(const test::Exposure& exposure, double height = 4)
      : GroundPair({640, 480}, 5, height, -8, 3) {
    render(exposure, exposure);
    disparities.choose(left, truth);
  }
  double meanError() const { return mean(disparities.disparities()).error; }
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

TEST(BlockDisparities, LeaveOutWhatTheWarpPutsBesideTheRightImage) {
  // Low ground leans so much that a block begins columns farther to the left in its last row.
  Blocks blocks({1, 0, 1}, 0.6);
  blocks.disparities.choose(blocks.left, blocks.off(-12));
  const auto measure = [&](uchar beside) {
    constexpr int kBeside = 40;
    cv::Mat wide;
    cv::copyMakeBorder(blocks.right, wide, 0, 0, kBeside, kBeside, cv::BORDER_CONSTANT, cv::Scalar(beside));
    blocks.disparities.measure(wide.colRange(kBeside, kBeside + blocks.right.cols), blocks.truth,
                               blocks.rows);
    return blocks.disparities.disparities();
  };
  const std::vector<BlockDisparity> black = measure(0), white = measure(255);
  ASSERT_GT(black.size(), 100u);
  ASSERT_EQ(black.size(), white.size());
  for (size_t i = 0; i < black.size(); ++i) {
    EXPECT_EQ(black[i].sample.disparity, white[i].sample.disparity) << i;
    EXPECT_EQ(black[i].alike, white[i].alike) << i;
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
