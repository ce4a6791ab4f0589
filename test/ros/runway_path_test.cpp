#include "runway_path.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace uav_landing;

namespace {

/// A level camera that flies 10 m/s forward, 1 m/s to the left and sinks 1 m/s.
LandingResult flying(double stamp) {
  LandingResult camera;
  camera.stamp = stamp;
  camera.height_valid = camera.angle_valid = true;
  camera.height = 50 - stamp;
  camera.pitch = camera.roll = camera.yaw = 0;
  camera.approach_angle = std::atan(0.1);
  camera.velocity = {-1, 1, 10};  // right, down, forward
  return camera;
}

TEST(RunwayPath, BeginsWhereThePathMeetsTheGroundAtTheOrigin) {
  RunwayPath path;
  const auto place = path.update(flying(0));
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->position.x(), -500, 1e-9) << "50 m high on a slope of 0.1";
  EXPECT_NEAR(place->position.z(), 50, 1e-12);
  EXPECT_GE(place->variance.x(), 1e6);
}

TEST(RunwayPath, SumsUpTheVelocity) {
  RunwayPath path;
  path.update(flying(0));
  path.update(flying(1));
  const auto place = path.update(flying(2));
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->position.x(), -480, 1e-9);
  EXPECT_NEAR(place->position.y(), 2, 1e-9);
  EXPECT_NEAR(place->position.z(), 48, 1e-12);
}

TEST(RunwayPath, KeepsTheWidthOfOneApproach) {
  RunwayPath path;
  EXPECT_TRUE(std::isnan(path.runwayWidth()));
  LandingResult camera = flying(1);
  camera.runway_width = 43.6;
  path.update(camera);
  path.update(flying(2));
  EXPECT_EQ(path.runwayWidth(), 43.6);
  path.update(flying(0));
  EXPECT_TRUE(std::isnan(path.runwayWidth())) << "another approach";
}

TEST(RunwayPath, OnePairOfAnotherWidthHardlyChangesIt) {
  RunwayPath path;
  const auto measure = [&](double stamp, double width) {
    LandingResult camera = flying(stamp);
    camera.runway_width = width;
    path.update(camera);
    return path.runwayWidth();
  };
  for (int i = 0; i < 40; ++i) measure(0.1 * i, 58);
  EXPECT_NEAR(measure(4.1, 62), 58.2, 1e-9);
  for (int i = 0; i < 100; ++i) measure(4.2 + 0.1 * i, 62);
  EXPECT_NEAR(path.runwayWidth(), 62, 0.1);
}

TEST(RunwayPath, TurnsTheVelocityIntoTheRunwayFrame) {
  RunwayPath path;
  LandingResult camera = flying(0);
  path.update(camera);
  camera.stamp = 1;
  camera.yaw = M_PI / 2;  // looks to the left and flies there
  camera.velocity = {0, 0, 10};
  const auto place = path.update(camera);
  EXPECT_NEAR(place->position.x(), -500, 1e-9);
  EXPECT_NEAR(place->position.y(), 10, 1e-9);
}

TEST(RunwayPath, TheVarianceGrows) {
  RunwayPath path;
  const double first = path.update(flying(0))->variance.x();
  path.update(flying(1));
  EXPECT_GT(path.update(flying(2))->variance.x(), first);
}

TEST(RunwayPath, FliesOnThroughPairsWithoutAnEstimate) {
  RunwayPath path;
  path.update(flying(0));
  LandingResult nothing;
  nothing.stamp = 1;
  EXPECT_FALSE(path.update(nothing));
  EXPECT_NEAR(path.update(flying(2))->position.x(), -480, 1e-9);
}

TEST(RunwayPath, ASpeedThatIsNotSeenAnyMoreMayBeAnother) {
  const auto varianceAfter = [](bool seen) {
    RunwayPath path;
    path.update(flying(0));
    for (int i = 1; i < 200; ++i) {
      LandingResult camera = flying(0);
      camera.stamp = i;
      if (!seen) camera.velocity.setConstant(kUnknown);
      path.update(camera);
    }
    LandingResult camera = flying(0);
    camera.stamp = 200;
    return path.update(camera)->variance.x();
  };
  // 10 m/s for 200 s.
  EXPECT_NEAR(varianceAfter(true), 1e6 + std::pow(0.05 * 2010, 2), 1e3);
  EXPECT_GT(varianceAfter(false), 1e6 + std::pow(1900, 2));
}

TEST(RunwayPath, AStampThatGoesBackBeginsAnew) {
  RunwayPath path;
  path.update(flying(10));
  path.update(flying(11));
  EXPECT_NEAR(path.update(flying(0))->position.x(), -500, 1e-9);
  EXPECT_EQ(path.track().size(), 1u);
}

TEST(RunwayPath, GoesWhereTheRunwayIsOnceItIsFoundAndTakesThePathBehindAlong) {
  RunwayPath path;
  path.update(flying(0));
  path.update(flying(1));
  LandingResult camera = flying(2);
  camera.y = -7;
  camera.y_variance = 0.25;
  const auto place = path.update(camera);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->position.y(), -7);
  EXPECT_EQ(place->variance.y(), 0.25);
  EXPECT_NEAR(place->position.x(), -480, 1e-9) << "not known";
  EXPECT_GE(place->variance.x(), 1e6);
  EXPECT_NEAR(path.track()[0].y(), -9, 1e-9) << "2 s at 1 m/s to the right";
}

TEST(RunwayPath, EachAxisIsKnownOnItsOwnAndUntilItIsLost) {
  RunwayPath path;
  path.update(flying(0));
  LandingResult camera = flying(1);
  camera.x = -300;
  camera.x_variance = 0.5;
  auto place = path.update(camera);
  EXPECT_EQ(place->position.x(), -300);
  EXPECT_EQ(place->variance.x(), 0.5);
  EXPECT_NEAR(place->position.y(), 1, 1e-9) << "not known";
  EXPECT_GE(place->variance.y(), 1e6);
  EXPECT_NEAR(path.track()[0].x(), -310, 1e-9) << "1 s at 10 m/s";
  place = path.update(flying(2));
  EXPECT_NEAR(place->position.x(), -290, 1e-9) << "on from where it was known";
  EXPECT_GE(place->variance.x(), 1e6);
  // Known again, and another place: the path moves there once more.
  camera = flying(3);
  camera.x = -200;
  camera.x_variance = 0.5;
  path.update(camera);
  EXPECT_NEAR(path.track()[0].x(), -230, 1e-9);
  // A place that stays known moves nothing that is behind.
  camera = flying(4);
  camera.x = -195;
  camera.x_variance = 0.5;
  path.update(camera);
  EXPECT_NEAR(path.track()[0].x(), -230, 1e-9);
}

TEST(RunwayPath, TheTrackIsBounded) {
  RunwayPath path;
  for (int i = 0; i < 5000; ++i) {
    LandingResult camera = flying(i);
    camera.height = 10;
    path.update(camera);
  }
  EXPECT_EQ(path.track().size(), 2000u);
}

}  // namespace
