#include "integrity/memory/height_memory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

/// A filter that knows height and sink rate.
HeightFilter settled(double height, double speed) {
  HeightFilter filter(1.5, 5, 5);
  filter.initialise(height, 1e-4);
  filter.updateSpeed(speed, 1e-4);
  return filter;
}

TEST(HeightMemory, CarriesTheHeightOnByTheMotion) {
  HeightMemory memory;
  double height = 20;
  for (int i = 0; i <= 24; ++i) {
    if (i > 0) {
      height -= 0.05;
      memory.carry(0.05, -1, 1e-4, 20);
    }
    memory.refresh(settled(height, -1), true, 1);
    if (i == 10) continue;  // the sum of the steps may be a hair less than half a second
    EXPECT_EQ(memory.expected().has_value(), i > 10) << "half a second at 20 Hz, frame " << i;
  }
  EXPECT_NEAR(memory.expected()->height, height, 0.02);
  // 0.15 degrees of half a second to a second at 20 m/s.
  EXPECT_GT(std::sqrt(memory.expected()->variance), 0.026);
  EXPECT_LT(std::sqrt(memory.expected()->variance), 0.1);
}

TEST(HeightMemory, KeepsTheOldHeightWhileTheNewOneContradictsUntilItIsOfNoUse) {
  HeightMemory memory;
  for (int i = 0; i < 25; ++i) {
    memory.carry(0.05, 0, 1e-4, 20);
    memory.refresh(settled(20, 0), true, 1);
  }
  double lasted = 0;
  while (memory.expected() && lasted < 60) {
    EXPECT_NEAR(memory.expected()->height, 20, 0.05);
    memory.carry(0.05, 0, 1e-4, 20);
    memory.refresh(settled(23, 0), false, 1);
    lasted += 0.05;
  }
  // 0.15 degrees at 20 m/s are 5 cm in a second: beyond a metre after about 19 s.
  EXPECT_GT(lasted, 10);
  EXPECT_LT(lasted, 25);
}

TEST(HeightMemory, IsAsUncertainAsTheHeightTheSpeedAndTheDirectionOfTheHorizontal) {
  // Without random acceleration the height of t later is h + v t, with a variance of its own.
  HeightFilter filter(0, 5, 5);
  filter.initialise(20, 0.04);
  filter.updateSpeed(0, 1e-4);
  HeightMemory memory;
  memory.refresh(filter, true, 10);
  for (int i = 0; i < 8; ++i) memory.carry(0.125, std::nan(""), std::nan(""), 16);
  memory.refresh(filter, true, 10);
  ASSERT_TRUE(memory.expected());
  EXPECT_NEAR(memory.expected()->height, 20, 1e-9);
  // In a second: 0.2 m, 1 cm/s, and 0.15 degrees of 16 m.
  const double variance = 0.04 + 1e-4 + std::pow(16 * 0.15 * M_PI / 180, 2);
  EXPECT_NEAR(memory.expected()->variance / variance, 1, 1e-3);
}

}  // namespace
}  // namespace uav_landing
