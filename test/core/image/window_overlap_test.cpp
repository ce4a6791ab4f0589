#include "image/windows/window_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace uav_landing {
namespace {

TEST(WindowOverlap, OfWindowsApartIsNone) {
  EXPECT_EQ(WindowOverlap(0).factor(), 1);
  WindowOverlap windows(3);
  windows.add(10, 10, 11);
  windows.add(21, 10, 11);
  windows.add(10, 21, 11);
  EXPECT_EQ(windows.factor(), 1);
}

TEST(WindowOverlap, IsThatOfSumsOverTheirPixels) {
  // The variance of the sum over all windows of sums over their pixels, each of which has noise of its own,
  // over what it were if no two windows had a pixel in common.
  constexpr int kSize = 100, kExtent = 9;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(0, kSize - kExtent);
  std::vector<std::array<int, 2>> corners(60);
  for (auto& [u, v] : corners) u = place(random), v = place(random);
  std::array<std::array<int, kSize>, kSize> counts{};
  WindowOverlap windows(corners.size());
  for (const auto& [u, v] : corners) {  // in no order
    windows.add(u, v, kExtent);
    for (int y = v; y < v + kExtent; ++y)
      for (int x = u; x < u + kExtent; ++x) ++counts[y][x];
  }
  double variance = 0;
  for (const auto& row : counts)
    for (const int count : row) variance += count * count;
  const double independent = static_cast<double>(corners.size()) * kExtent * kExtent;
  EXPECT_NEAR(windows.factor(), variance / independent, 1e-5);
  EXPECT_GT(windows.factor(), 1.3);
}

TEST(WindowOverlap, OfAnyNumberOfWindowsInAnyOrderIsThatOfAllPairs) {
  constexpr double kExtent = 11;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(0, 60);
  for (size_t count = 1; count <= 40; ++count) {
    std::vector<std::array<double, 2>> corners(count);
    for (auto& [u, v] : corners) u = place(random), v = 3 * place(random);
    if (count % 3 != 0)  // mostly from the top down, as corners come
      std::sort(corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
    WindowOverlap windows(count % 2 == 0 ? count : 0);
    double shared = 0;
    for (const auto& [u, v] : corners) {
      windows.add(u, v, kExtent);
      for (const auto& [x, y] : corners)
        shared += std::max(0.0, 1 - std::abs(u - x) / kExtent) * std::max(0.0, 1 - std::abs(v - y) / kExtent);
    }
    EXPECT_NEAR(windows.factor(), shared / static_cast<double>(count), 1e-5) << count;
  }
}

TEST(WindowOverlap, WindowsOfNoExtentShareNothing) {
  WindowOverlap windows(2);
  windows.add(10, 10, 0);
  windows.add(10, 10, 0);
  EXPECT_EQ(windows.factor(), 1);
}

}  // namespace
}  // namespace uav_landing
