#include "height/runway_height.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

/// 20 m high known to 2 cm, over the place x known to 1 m.
LandingResult landingAt(double x) {
  LandingResult landing;
  landing.height_valid = true;
  landing.height = 20;
  landing.height_variance = 4e-4;
  landing.x = x;
  landing.x_variance = 1;
  return landing;
}

TEST(RunwayHeight, OverTheRunwayItIsThatAboveThePlaneAhead) {
  const RunwayHeight found = runwayHeight(landingAt(50), 0.3, false);
  EXPECT_DOUBLE_EQ(found.height, 19.7);
  EXPECT_DOUBLE_EQ(found.variance, 4e-4);
}

TEST(RunwayHeight, BeforeItTheGroundMaySlope) {
  const RunwayHeight found = runwayHeight(landingAt(-300), 0, false);
  EXPECT_DOUBLE_EQ(found.height, 20);
  // Half a degree over 301 m.
  EXPECT_NEAR(std::sqrt(found.variance), 2.63, 0.01);
}

TEST(RunwayHeight, IsUnknownBeforeTheThresholdIsSeenAndWithoutAValidHeight) {
  LandingResult landing = landingAt(kUnknown);
  EXPECT_TRUE(std::isnan(runwayHeight(landing, 0, false).height));
  landing = landingAt(50);
  landing.height_valid = false;
  EXPECT_TRUE(std::isnan(runwayHeight(landing, 0, false).height));
  EXPECT_TRUE(std::isnan(runwayHeight(landing, 0, false).variance));
}

TEST(RunwayHeight, AKnownWidthTellsWhatTheGroundBeforeItDoesNot) {
  LandingResult landing = landingAt(-300);
  landing.width_height = 24;
  landing.width_height_variance = 0.01;
  EXPECT_DOUBLE_EQ(runwayHeight(landing, 0, false).height, 20)
      << "a width that was learned is of the heights";
  const RunwayHeight found = runwayHeight(landing, 0, true);
  EXPECT_NEAR(found.height, 24, 0.02);
  EXPECT_NEAR(std::sqrt(found.variance), 0.1, 1e-3);
  landing.x = 100;
  EXPECT_TRUE(std::isnan(runwayHeight(landing, 0, true).height)) << "4 m off on the runway itself";
}

}  // namespace
}  // namespace uav_landing
