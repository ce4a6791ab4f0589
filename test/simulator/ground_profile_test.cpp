#include "simulator/ground/ground_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace uav_landing {
namespace {

SimulatedProfileParameters hill() {
  SimulatedProfileParameters p;
  p.hill_height = 20;
  p.hill_x = -500;
  p.hill_length = 400;  // from -700 to -300
  return p;
}

TEST(GroundProfile, AHillHasItsHeightAtItsTopAndHalfOfItHalfWayUp) {
  const GroundProfile ground(hill());
  EXPECT_FALSE(ground.flat());
  EXPECT_NEAR(ground.height(-500), 20, 1e-9);
  for (const double x : {-600.0, -400.0}) EXPECT_NEAR(ground.height(x), 10, 1e-9) << x;
  for (const double x : {-5000.0, -700.0, -300.0, 0.0, 5000.0}) EXPECT_NEAR(ground.height(x), 0, 1e-9) << x;
  // A parabola through the foot: a quarter of the way up to the half-way point makes a quarter of its height.
  EXPECT_NEAR(ground.height(-650), 2.5, 1e-9);
}

TEST(GroundProfile, AHillAddsToTheSlopesBelowIt) {
  SimulatedProfileParameters slopes;
  slopes.slope_before_deg = -1;
  slopes.slope_after_deg = 2;
  slopes.change_start = -550;
  slopes.change_length = 300;
  SimulatedProfileParameters both = slopes;
  both.hill_height = hill().hill_height;
  both.hill_x = hill().hill_x;
  both.hill_length = hill().hill_length;
  for (double x = -900; x < 200; x += 7)
    EXPECT_NEAR(GroundProfile(both).height(x),
                GroundProfile(slopes).height(x) + GroundProfile(hill()).height(x), 1e-9)
        << x;
}

TEST(GroundProfile, ARayMeetsTheFirstGroundOnItsWay) {
  const GroundProfile ground(hill());
  cv::RNG random(3);
  int on_hill = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d centre(-900, 0, random.uniform(5.0, 40.0));
    const Eigen::Vector3d direction(1, random.uniform(-0.5, 0.5), random.uniform(-0.15, -0.005));
    // The first step below the ground, in steps of 5 cm.
    double along = 0;
    while (centre.z() + along * direction.z() > ground.height(centre.x() + along)) along += 0.05;
    const GroundProfile::Line tangent = ground.seen(centre, direction);
    const double x = centre.x() + along;
    EXPECT_NEAR(tangent.at(x), ground.height(x), 1e-3) << x;
    EXPECT_NEAR(tangent.slope, (ground.height(x + 0.01) - ground.height(x - 0.01)) / 0.02, 1e-3) << x;
    on_hill += x > -700 && x < -300 ? 1 : 0;
  }
  EXPECT_GT(on_hill, 50);
}

}  // namespace
}  // namespace uav_landing
