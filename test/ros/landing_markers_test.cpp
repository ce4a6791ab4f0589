#include "landing_markers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace uav_landing {
namespace {

LandingResult estimate() {
  LandingResult result;
  result.height_valid = result.angle_valid = true;
  result.height = 20;
  result.height_variance = 1e-4;
  result.approach_angle = 0.1;
  return result;
}

const visualization_msgs::Marker& named(const visualization_msgs::MarkerArray& array,
                                        const std::string& name) {
  for (const auto& marker : array.markers)
    if (marker.ns == name) return marker;
  throw std::runtime_error("no marker " + name);
}

/// An aircraft 20 m above the ground, 100 m before the threshold.
visualization_msgs::MarkerArray draw(const NodeParameters& parameters, const Eigen::Vector3d& stddev) {
  const DrawnAircraft aircraft{{-100, 1, 20}, stddev, Eigen::Matrix3d::Identity()};
  return drawLanding({}, parameters, estimate(), aircraft, {1, 0}, {});
}

TEST(LandingMarkers, EllipsoidIsSixSigmaWideTimesItsScale) {
  NodeParameters parameters;
  parameters.ellipsoid_scale = 25;
  const auto array = draw(parameters, {0.3, 0.05, 0.02});
  const auto& ellipsoid = named(array, "uncertainty");
  EXPECT_EQ(ellipsoid.action, visualization_msgs::Marker::ADD);
  EXPECT_NEAR(ellipsoid.scale.x, 45, 1e-9);
  EXPECT_NEAR(ellipsoid.scale.y, 7.5, 1e-9);
  EXPECT_NEAR(ellipsoid.scale.z, 3, 1e-9);
  EXPECT_EQ(ellipsoid.pose.position.z, 20);
  EXPECT_NE(named(array, "numbers").text.find("ellipsoid 3 sigma x 25"), std::string::npos);
}

TEST(LandingMarkers, EllipsoidOfAnUnknownPlaceIsTakenAway) {
  const auto array = draw({}, {1e3, 0.05, 0.02});
  EXPECT_EQ(named(array, "uncertainty").action, visualization_msgs::Marker::DELETE);
  EXPECT_EQ(named(array, "numbers").text.find("ellipsoid"), std::string::npos);
}

TEST(LandingMarkers, GlidePathEndsWhereItMeetsTheGround) {
  const auto array = draw({}, {0.3, 0.05, 0.02});
  const auto& path = named(array, "glide_path");
  ASSERT_EQ(path.points.size(), 2u);
  EXPECT_NEAR(path.points[1].x, -100 + 20 / std::tan(0.1), 1e-6);
  EXPECT_EQ(path.points[1].z, 0);
}

TEST(LandingMarkers, WhatIsRemovedIsWhatWasDrawn) {
  const auto drawn = draw({}, {0.3, 0.05, 0.02});
  const auto lost = drawLanding({}, {}, estimate(), std::nullopt, {1, 0}, {});
  for (const char* name : {"aircraft", "glide_path", "uncertainty"}) {
    EXPECT_EQ(named(drawn, name).action, visualization_msgs::Marker::ADD) << name;
    EXPECT_EQ(named(lost, name).action, visualization_msgs::Marker::DELETE) << name;
    EXPECT_EQ(named(lost, name).id, named(drawn, name).id) << name;
  }
}

TEST(LandingMarkers, WithoutAnAircraftRunwayPathAndNumbersAreLeft) {
  const auto array = drawLanding({}, {}, estimate(), std::nullopt, {1, 0}, {{0, 0, 3}, {1, 0, 2}});
  std::multiset<std::string> shown, removed;
  for (const auto& marker : array.markers)
    (marker.action == visualization_msgs::Marker::ADD ? shown : removed).insert(marker.ns);
  EXPECT_EQ(shown, (std::multiset<std::string>{"numbers", "path", "runway", "runway", "runway"}));
  EXPECT_EQ(removed, (std::multiset<std::string>{"aircraft", "glide_path", "uncertainty"}));
  EXPECT_EQ(named(array, "path").points.size(), 2u);
  EXPECT_NE(named(array, "numbers").text.find("height 20.00 m"), std::string::npos);
}

}  // namespace
}  // namespace uav_landing
