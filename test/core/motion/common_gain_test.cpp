#include "motion/matching/common_gain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace uav_landing {
namespace {

/// Windows of means 60 .. 140 then, brighter now by the gain and an offset of 12, scattered by so much.
std::vector<WindowMeans> windowsOf(double gain, double scatter, int count = 200) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> level(60, 140);
  std::normal_distribution<double> normal;
  std::vector<WindowMeans> windows;
  for (int i = 0; i < count; ++i) {
    const double then = level(random);
    windows.push_back({gain * then + 12 + scatter * normal(random), then});
  }
  return windows;
}

TEST(CommonGain, IsTheSlopeOfTheLineThroughTheMeans) {
  for (const double gain : {0.7, 1.0, 1.4}) {
    const CommonGain exact = commonGain(windowsOf(gain, 0));
    EXPECT_NEAR(exact.gain, gain, 1e-9);
    EXPECT_LT(exact.variance, 1e-9);
    // 200 means that scatter by 2 tell the slope to 2 / 23 / sqrt(200).
    EXPECT_NEAR(commonGain(windowsOf(gain, 2)).gain, gain, 0.02);
  }
}

TEST(CommonGain, LeavesOutWindowsThatAreOffTheLine) {
  std::vector<WindowMeans> windows = windowsOf(0.9, 0.5);
  for (size_t i = 0; i < windows.size(); i += 10) windows[i].now += 40;
  const CommonGain common = commonGain(windows);
  EXPECT_NEAR(common.gain, 0.9, 0.005);
  EXPECT_LT(std::sqrt(common.variance), 0.05);
}

TEST(CommonGain, IsInDoubtByTheScatterHoweverManyWindowsThereAre) {
  // Means spread by 80 / sqrt(12) and scatter by 2.
  const double expected = 2 / (80 / std::sqrt(12.0));
  for (const int count : {50, 2000})
    EXPECT_NEAR(std::sqrt(commonGain(windowsOf(1, 2, count)).variance), expected, 0.2 * expected) << count;
  // A third of the windows as bright as can be.
  std::vector<WindowMeans> clipped = windowsOf(0.7, 0.5, 2000);
  for (WindowMeans& means : clipped)
    if (means.then > 113) means = {means.now + 30, 113};
  EXPECT_GT(std::sqrt(commonGain(clipped).variance), 0.1);
}

TEST(CommonGain, IsUnknownWhereTheMeansTellNoLine) {
  EXPECT_TRUE(std::isinf(commonGain({}).variance));
  EXPECT_TRUE(std::isinf(commonGain(windowsOf(1, 0, 3)).variance));
  EXPECT_TRUE(std::isinf(commonGain(std::vector<WindowMeans>(20, {80, 80})).variance));
  EXPECT_TRUE(std::isinf(commonGain(std::vector<WindowMeans>(20, {NAN, 80})).variance));
}

}  // namespace
}  // namespace uav_landing
