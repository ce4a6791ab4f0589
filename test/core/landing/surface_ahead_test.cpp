#include "landing/height/surface_ahead.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/kalman_height_inputs.h"

namespace uav_landing {
namespace {

using test::kStep;
using test::stereoAt;

/// Unevenness after one more pair whose surface seems to have this variance.
double unevennessAfter(SurfaceAhead& surface, double variance, bool known = true) {
  StereoDepthResult stereo = stereoAt(0, 20);
  stereo.surface_variance = variance;
  return surface.follow(stereo, stereo.plane, known).unevenness;
}

TEST(SurfaceAhead, IsAsUnevenAsThePairsAgree) {
  SurfaceAhead surface(true);
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(unevennessAfter(surface, 0.04), 0.04, 1e-12) << i;
}

TEST(SurfaceAhead, AVarianceThatNoiseMakesNegativeIsNone) {
  SurfaceAhead surface(true);
  EXPECT_EQ(unevennessAfter(surface, -0.04), 0);
}

// Twenty pairs that scatter by 0.3 m^2 know their mean to 0.3 / sqrt(20) = 0.067 m^2.
TEST(SurfaceAhead, IsLessUnevenThanThePairsMeanByTheErrorOfThatMean) {
  const auto after = [](double mean) {
    SurfaceAhead surface(true);
    double unevenness = 0;
    for (int i = 0; i < 40; ++i) unevenness = unevennessAfter(surface, mean + (i % 2 == 0 ? 0.3 : -0.3));
    return unevenness;
  };
  EXPECT_EQ(after(0.04), 0) << "as flat ground may look";
  EXPECT_NEAR(after(0.2), 0.2 - 0.067, 0.02);
}

TEST(SurfaceAhead, ForgetsUnevenGroundThatIsBehind) {
  SurfaceAhead surface(true);
  for (int i = 0; i < 20; ++i) unevennessAfter(surface, 0.04);
  double unevenness = 1;
  for (int i = 0; i < 100; ++i) unevenness = unevennessAfter(surface, 0);
  EXPECT_LT(unevenness, 0.001);
}

TEST(SurfaceAhead, BeginsAnewWithEachPairWhileThereIsNoHeight) {
  SurfaceAhead surface(true);
  for (int i = 0; i < 20; ++i) unevennessAfter(surface, 0.04);
  EXPECT_NEAR(unevennessAfter(surface, 0.01, false), 0.01, 1e-12);
  EXPECT_NEAR(unevennessAfter(surface, 0.03, false), 0.03, 1e-12);
}

TEST(SurfaceAhead, APairThatDoesNotTellTheUnevennessLeavesItAsItWas) {
  SurfaceAhead surface(true);
  for (int i = 0; i < 20; ++i) unevennessAfter(surface, 0.04);
  EXPECT_NEAR(unevennessAfter(surface, std::nan("")), 0.04, 1e-12);
  EXPECT_NEAR(surface.carry(1).unevenness, 0.04, 1e-12) << "nor one without a plane";
}

/// The plane ahead is 20 m below, the surface straight below 20.5 m, known to 0.1 m and 0.3 m.
StereoDepthResult bentSurface(double stamp) {
  StereoDepthResult stereo = stereoAt(stamp, 20, -0.1, 0.05, 0.1);
  stereo.below = stereoAt(stamp, 20.5, -0.1, 0.05, 0.3).plane;
  return stereo;
}

TEST(SurfaceAhead, TheBendIsTheHeightBelowLessThatOfThePlaneAhead) {
  const StereoDepthResult stereo = bentSurface(0);
  const SurfaceAhead::Shape shape = SurfaceAhead(true).follow(stereo, stereo.plane, true);
  EXPECT_NEAR(shape.below.height(), 20.5, 1e-9);
  EXPECT_NEAR(shape.bend, 0.5, 1e-9);
  EXPECT_NEAR(shape.bend_variance, 0.3 * 0.3 - 0.1 * 0.1, 1e-9);
}

TEST(SurfaceAhead, WhatCorrectsThePlaneAheadCorrectsTheTangentBelow) {
  const StereoDepthResult stereo = bentSurface(0);
  GroundPlane corrected = stereo.plane;
  corrected.g += Eigen::Vector3d(0, 1e-3, 2e-3);
  const SurfaceAhead::Shape shape = SurfaceAhead(true).follow(stereo, corrected, true);
  EXPECT_NEAR((shape.below.g - stereo.below.g - Eigen::Vector3d(0, 1e-3, 2e-3)).norm(), 0, 1e-12);
}

TEST(SurfaceAhead, ATangentAsCertainAsThePlaneLeavesNothingOpen) {
  StereoDepthResult stereo = bentSurface(0);
  stereo.below.covariance = 0.1 * stereo.plane.covariance;
  EXPECT_EQ(SurfaceAhead(true).follow(stereo, stereo.plane, true).bend_variance, 0);
}

TEST(SurfaceAhead, HasNoBendWhereNoneIsWantedOrSeen) {
  StereoDepthResult stereo = bentSurface(0);
  const SurfaceAhead::Shape unwanted = SurfaceAhead(false).follow(stereo, stereo.plane, true);
  stereo.below = {};
  const SurfaceAhead::Shape unseen = SurfaceAhead(true).follow(stereo, stereo.plane, true);
  for (const SurfaceAhead::Shape& shape : {unwanted, unseen}) {
    EXPECT_NEAR(shape.below.height(), 20, 1e-9);
    EXPECT_EQ(shape.bend, 0);
    EXPECT_EQ(shape.bend_variance, 0);
  }
}

TEST(SurfaceAhead, AfterASecondWithoutAPlaneTheBendMayBeNoneOrTwiceAsLarge) {
  SurfaceAhead surface(true);
  EXPECT_EQ(surface.carry(3).bend, 0) << "none has been seen";
  EXPECT_EQ(surface.carry(3).bend_variance, 0);
  const StereoDepthResult stereo = bentSurface(5);
  surface.follow(stereo, stereo.plane, true);
  for (const double age : {kStep, 1.0}) {
    const SurfaceAhead::Shape shape = surface.carry(5 + age);
    EXPECT_NEAR(shape.bend, 0.5, 1e-9);
    EXPECT_NEAR(shape.bend_variance, 0.08 + std::pow(0.5 * age, 2), 1e-9);
    EXPECT_FALSE(shape.below.valid());
  }
}

}  // namespace
}  // namespace uav_landing
