#include "stereo/photometric/shift_matching.h"

#include <gtest/gtest.h>

#include <vector>

namespace uav_landing {
namespace {

constexpr int kSection = 128, kBlock = 16;

/// One block with a signal of so many sigma, at this place; its shift is 0.5 px.
ShiftEvidence block(double signal, double u, double v) {
  ShiftEvidence evidence;
  evidence.blocks = 1;
  evidence.signal = signal;
  evidence.signal_variance = 1;
  evidence.usual = 1000;  // hardly a prior
  evidence.energy = signal;
  evidence.score = 0.5 * signal;
  evidence.score_variance = 1;
  evidence.moment_u = evidence.energy * u;
  evidence.moment_v = evidence.energy * v;
  return evidence;
}

class Sections : public testing::Test {
 protected:
  void add(double signal, int u, int v, bool alike = true) { matching.add(block(signal, u, v), alike, u, v); }
  std::vector<int> blocksOfMatches(bool alike = true) const {
    std::vector<int> blocks;
    for (const ShiftMatch& match : matches)
      if (match.alike == alike) blocks.push_back(match.blocks);
    return blocks;
  }
  std::vector<ShiftMatch> matches;
  ShiftMatching matching{1, kSection, matches};
};

using Counts = std::vector<int>;

TEST_F(Sections, CertainBlocksSpeakForThemselves) {
  for (int i = 0; i < 3; ++i) add(20, i * kBlock, 0);
  matching.finish();
  EXPECT_EQ(blocksOfMatches(), Counts({1, 1, 1}));
  EXPECT_NEAR(matches[1].u, kBlock, 1e-9);
  EXPECT_NEAR(matches[1].shift, 0.5, 0.01);
  EXPECT_NEAR(matches[1].stddev, 1.0 / 20, 0.002);
}

TEST_F(Sections, WeakOnesSpeakTogetherUntilTheyAreCertain) {
  for (int i = 0; i < 8; ++i) add(3.5, i * kBlock, 40);
  matching.finish();
  EXPECT_EQ(blocksOfMatches(), Counts({3, 3, 2})) << "3 x 3.5 / sqrt(3) is 6.06";
  EXPECT_NEAR(matches[0].u, kBlock, 1e-9) << "the middle of the first three";
  EXPECT_NEAR(matches[0].v, 40, 1e-9);
  EXPECT_NEAR(matches[0].shift, 0.5, 0.02);
}

TEST_F(Sections, EndWithTheirWidthAndTheRow) {
  for (const int u : {96, 112, 128, 144}) add(2, u, 0);
  for (const int u : {0, 16, 32}) add(2, u, 8);
  matching.finish();
  EXPECT_EQ(blocksOfMatches(), Counts({2, 2, 3}));
}

TEST_F(Sections, KeepApartWhatTheRightImageDoesNotShow) {
  for (int i = 0; i < 8; ++i) add(2, i * kBlock, 0, i != 3);
  add(20, 200, 0, false);
  matching.finish();
  EXPECT_EQ(blocksOfMatches(), Counts({7}));
  EXPECT_EQ(blocksOfMatches(false), Counts({1, 1}));
}

TEST_F(Sections, BlocksOfNoiseSayNothing) {
  ShiftEvidence noise = block(0.001, 0, 0);
  noise.energy = 100;
  matching.add(noise, true, 0, 0);
  matching.finish();
  EXPECT_TRUE(matches.empty());
}

}  // namespace
}  // namespace uav_landing
