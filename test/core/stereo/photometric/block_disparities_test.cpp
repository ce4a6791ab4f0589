#include "stereo/photometric/block_disparities.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/ground_pair.h"

namespace uav_landing {
namespace {

/// The blocks of a pair's images.
struct Blocks : test::GroundPair {
  BlockDisparities disparities{level()};

  explicit Blocks(const test::Exposure& exposure) : GroundPair({640, 480}, 5, 4, -8, 3) {
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

TEST(BlockDisparities, AreBeyondDoubtInClearImages) {
  Blocks clear({1, 0, 1}), faint({0.15, 90, 6});
  for (Blocks* blocks : {&clear, &faint})
    blocks->disparities.measure(blocks->right, blocks->truth, blocks->rows);
  EXPECT_GT(clear.disparities.certainShare(), 0.95);
  EXPECT_LT(faint.disparities.certainShare(), 0.3);
}

}  // namespace
}  // namespace uav_landing
