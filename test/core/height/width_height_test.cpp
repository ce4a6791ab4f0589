#include "height/width_height.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing {
namespace {

constexpr double kWidth = 45;

TEST(WidthHeight, OfAKnownWidthIsTheWidthOverWhatIsSeen) {
  const WidthHeight width(kWidth);
  EXPECT_TRUE(width.independent());
  const auto estimate = width.height(3, 1e-4);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->height, 15, 1e-12);
  // 1 % of 3 and 0.2 % of the width, as shares of the height of 15 m.
  EXPECT_NEAR(std::sqrt(estimate->variance), 15 * std::hypot(0.01 / 3, 0.002), 1e-9);
  EXPECT_NEAR(std::sqrt(estimate->common), 15 * 0.002, 1e-9);
}

TEST(WidthHeight, OfAChartIsAsUncertainAsThePlaceOfTheStripes) {
  // Edges of 45 m, or of stripes 1.25 m inside: as well 45 m as 42.5 m.
  const WidthHeight width(kWidth, 1.25);
  const auto estimate = width.height(43.75 / 15, 1e-10);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->height, 15, 1e-9);
  EXPECT_NEAR(std::sqrt(estimate->common), 15 * std::hypot(1.25, 0.09) / 43.75, 1e-3);
}

TEST(WidthHeight, StereoTellsBetterThanAChartWhichEdgesAreSeen) {
  WidthHeight width(kWidth, 1.25);
  EXPECT_TRUE(width.independent());
  for (int i = 0; i < 5; ++i) width.learn(42.6 / 15, 1e-8, 15, 1e-4);
  EXPECT_FALSE(width.independent()) << "what is known now is of stereo";
  ASSERT_TRUE(width.height(42.6 / 15, 1e-8));
  EXPECT_NEAR(width.height(42.6 / 15, 1e-8)->height, 15, 0.01);
  WidthHeight exact(kWidth);
  for (int i = 0; i < 5; ++i) exact.learn(44.9 / 15, 1e-8, 15, 0.01);
  EXPECT_TRUE(exact.independent()) << "stereo knows less";
}

TEST(WidthHeight, IsNotKnownBeforeTheWidthWasLearned) {
  WidthHeight width(0);
  EXPECT_FALSE(width.independent());
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(width.height(3, 1e-6));
    width.learn(3, 1e-6, 15, 1e-4);
  }
  const auto estimate = width.height(4.5, 1e-6);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->height, 10, 1e-9);
}

TEST(WidthHeight, LearnedFromManyEqualHeightsIsNoBetterThanOneOfThem) {
  WidthHeight width(0);
  for (int i = 0; i < 500; ++i) width.learn(3, 1e-10, 15, 0.04);
  const auto estimate = width.height(3, 1e-10);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(std::sqrt(estimate->variance), 0.2, 1e-3);
}

TEST(WidthHeight, EdgesThatWereNotLearnedFromAreTold) {
  WidthHeight width(0);
  for (int i = 0; i < 8; ++i) width.learn(3, 1e-8, 15, 1e-4);
  // Lines 1.2 m inside of both edges of 45 m: 5 %.
  EXPECT_FALSE(width.isSame(42.6 / 15, 1e-8, 15, 1e-4));
  EXPECT_FALSE(width.isSame(44.1 / 15, 1e-8, 15, 1e-4)) << "the lines' edges within the surface's";
  EXPECT_TRUE(width.isSame(44.9 / 14, 1e-8, 14, 1e-4));
  EXPECT_TRUE(width.isSame(42.6 / 15, 1e-8, 15, 0.16)) << "as far as the height is known";
  EXPECT_FALSE(WidthHeight(kWidth).isSame(42.6 / 15, 1e-8, 15, 1e-4)) << "nor are they a known width's";
}

TEST(WidthHeight, OtherEdgesRemainOthersHoweverLittleIsKnownOfTheHeight) {
  WidthHeight width(kWidth);
  EXPECT_TRUE(width.isSame(42.6 / 15, 1e-8, 15, 1)) << "nothing told that they are others";
  EXPECT_FALSE(width.isSame(42.6 / 15, 1e-8, 15, 1e-4));
  EXPECT_FALSE(width.isSame(42.6 / 15, 1e-8, 15, 1));
  EXPECT_FALSE(width.isSame(44.5 / 15, 1e-8, 15, 1)) << "1.1 %, with the width known to 0.2 %";
  EXPECT_TRUE(width.isSame(44.7 / 15, 1e-8, 15, 1)) << "0.7 %: one pair that saw others is no more than that";
  EXPECT_TRUE(width.isSame(42.6 / 15, 1e-8, 15, 1));
}

TEST(WidthHeight, ALearnedWidthThatTookAnothersPlaceIsThatOfItsOwnEdges) {
  WidthHeight width(0);
  for (int i = 0; i < 8; ++i) width.learn(3, 1e-8, 15, 1e-4);
  EXPECT_FALSE(width.isSame(3.3, 1e-8, 15, 1e-4));
  for (int i = 0; i < 5; ++i) width.learn(3.3, 1e-8, 15, 1e-4);
  EXPECT_TRUE(width.isSame(3.3 * 1.05, 1e-8, 15, 1));
}

TEST(WidthHeight, AnotherEdgeInBetweenDoesNotMakeForgetTheOnesBefore) {
  WidthHeight width(0);
  for (int i = 0; i < 8; ++i) width.learn(3, 1e-8, 15, 1e-4);
  for (int i = 0; i < 4; ++i) width.learn(2.84, 1e-8, 15, 1e-4);
  width.learn(3, 1e-8, 15, 1e-4);
  width.learn(2.84, 1e-8, 15, 1e-4);
  ASSERT_TRUE(width.height(3, 1e-8));
  EXPECT_NEAR(width.height(3, 1e-8)->height, 15, 1e-9);
}

TEST(WidthHeight, OtherEdgesAreLearnedWhenSomePairsInARowSawThem) {
  WidthHeight width(0);
  for (int i = 0; i < 8; ++i) width.learn(3, 1e-8, 15, 1e-4);
  for (int i = 0; i < 5; ++i) width.learn(3.3, 1e-8, 15, 1e-4);
  ASSERT_TRUE(width.height(3.3, 1e-8));
  EXPECT_NEAR(width.height(3.3, 1e-8)->height, 15, 1e-9);
}

TEST(WidthHeight, NothingIsMadeOfNothing) {
  const WidthHeight width(kWidth);
  EXPECT_FALSE(width.height(std::nan(""), 1e-4));
  EXPECT_FALSE(width.height(3, std::nan("")));
  EXPECT_FALSE(width.height(0, 1e-4));
}

TEST(WidthHeight, LearnedOnceIsAsUncertainAsHeightsBySamplesOfIt) {
  // A width that is seen at 15 m to 0.1 m of height, and again at 10 m; both to 0.01 heights.
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  constexpr int kSamples = 20000;
  double squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double width = (kWidth / 15 + 0.01 * normal(random)) * (15 + 0.1 * normal(random));
    squares += std::pow(width / (kWidth / 10 + 0.01 * normal(random)) - 10, 2) / kSamples;
  }
  WidthHeight learned(0);
  for (int i = 0; i < 5; ++i) learned.learn(kWidth / 15, 1e-4, 15, 0.01);
  const auto estimate = learned.height(kWidth / 10, 1e-4);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->variance / squares, 1, 0.05);
}

}  // namespace
}  // namespace uav_landing
