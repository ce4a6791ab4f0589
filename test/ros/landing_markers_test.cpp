#include "landing_markers.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
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

/// Looks along the runway: optical axes right, down, forward.
Eigen::Matrix3d straightAhead() { return (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished(); }

/// An aircraft 20 m above the ground, 100 m before the threshold.
visualization_msgs::MarkerArray draw(const NodeParameters& parameters, const Eigen::Vector3d& stddev,
                                     double runway_width = kUnknown) {
  const DrawnAircraft aircraft{{-100, 1, 20}, stddev, straightAhead()};
  return drawLanding({}, parameters, estimate(), aircraft, {1, 0}, {}, runway_width).markers;
}

Eigen::Vector3d vector(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }

/// From the smallest to the largest coordinates of its points.
Eigen::AlignedBox3d boxOf(const visualization_msgs::Marker& marker) {
  Eigen::AlignedBox3d box;
  for (const auto& p : marker.points) box.extend(vector(p));
  return box;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(LandingMarkers, EllipsoidIsSixSigmaWideTimesItsScale) {
  NodeParameters parameters;
  parameters.ellipsoid_scale = 25;
  const auto array = draw(parameters, {0.1, 0.05, 0.02});
  const auto& ellipsoid = named(array, "uncertainty");
  EXPECT_EQ(ellipsoid.action, visualization_msgs::Marker::ADD);
  const Eigen::AlignedBox3d box = boxOf(ellipsoid);
  EXPECT_LT((box.sizes() - Eigen::Vector3d(15, 7.5, 3)).norm(), 1e-6) << box.sizes().transpose();
  EXPECT_LT((box.center() - Eigen::Vector3d(-100, 1, 20)).norm(), 1e-6);
  EXPECT_NE(named(array, "numbers").text.find("ellipsoid 3 sigma x 25"), std::string::npos);
}

TEST(LandingMarkers, EllipsoidIsNotLongerThanTheAircraftIsHigh) {
  const Eigen::Vector3d size = boxOf(named(draw({}, {2, 0.05, 0.02}), "uncertainty")).sizes();
  EXPECT_NEAR(size.x(), 20, 1e-6);
  EXPECT_NEAR(size.y(), 3, 1e-6);
}

TEST(LandingMarkers, RunwayIsAsWideAsMeasured) {
  NodeParameters parameters;
  parameters.drawn_runway_width = 20;
  for (const auto& [measured, drawn] : {std::pair(kUnknown, 20.0), std::pair(43.6, 43.6)}) {
    const auto array = draw(parameters, {0.3, 0.05, 0.02}, measured);
    for (const auto& marker : array.markers) {
      if (marker.ns == "runway" && marker.type != visualization_msgs::Marker::LINE_LIST) {
        EXPECT_NEAR(boxOf(marker).sizes().y(), drawn, 1e-9) << marker.id;
      }
    }
  }
}

TEST(LandingMarkers, AllAreOfTheTimeAndInTheFrameOfTheEstimate) {
  std_msgs::Header header;
  header.stamp = ros::Time(1000.5);
  header.frame_id = "runway";
  const DrawnAircraft aircraft{{-100, 1, 20}, {0.1, 0.05, 0.02}, straightAhead()};
  for (const std::optional<DrawnAircraft>& shown :
       {std::optional(aircraft), std::optional<DrawnAircraft>()}) {
    const LandingScene scene = drawLanding(header, {}, estimate(), shown, {1, 0}, {}, kUnknown);
    EXPECT_EQ(scene.markers.markers.size(), 8u);
    for (const auto& marker : scene.markers.markers) EXPECT_EQ(marker.header, header) << marker.ns;
    EXPECT_EQ(scene.view.header, header);
  }
}

TEST(LandingMarkers, TheSurfaceFillsTheRunwaysOutline) {
  NodeParameters parameters;
  parameters.drawn_runway_length = 900;
  parameters.drawn_runway_width = 20;
  const auto array = draw(parameters, {0.3, 0.05, 0.02});
  const auto& surface = array.markers.at(0);
  ASSERT_EQ(surface.type, visualization_msgs::Marker::TRIANGLE_LIST);
  ASSERT_EQ(surface.points.size(), 6u);
  double area = 0;
  for (size_t i = 0; i < 6; i += 3) {
    const Eigen::Vector3d corner = vector(surface.points[i]);
    area +=
        0.5 * (vector(surface.points[i + 1]) - corner).cross(vector(surface.points[i + 2]) - corner).norm();
  }
  EXPECT_NEAR(area, 900 * 20, 1e-6) << "two halves of a rectangle";
  const auto& outline = array.markers.at(1);
  ASSERT_EQ(outline.type, visualization_msgs::Marker::LINE_STRIP);
  for (const auto* marker : {&surface, &outline}) {
    const Eigen::AlignedBox3d box = boxOf(*marker);
    EXPECT_NEAR(box.min().x(), 0, 1e-9);
    EXPECT_NEAR(box.max().x(), 900, 1e-9);
    EXPECT_NEAR(box.min().y(), -10, 1e-9);
    EXPECT_NEAR(box.max().y(), 10, 1e-9);
  }
  EXPECT_LT(surface.points[0].z, outline.points[0].z) << "the lines are above it";
}

TEST(LandingMarkers, NumbersAreThoseOfTheEstimate) {
  LandingResult landing = estimate();
  landing.status = Status::kTracking;
  landing.vertical_speed = -1.25;
  landing.approach_angle = 3 * M_PI / 180;
  landing.height_protection_level = 0.5;
  const auto linesFor = [&] {
    return linesOf(
        named(drawLanding({}, {}, landing, std::nullopt, {1, 0}, {}, kUnknown).markers, "numbers").text);
  };
  EXPECT_EQ(linesFor(), (std::vector<std::string>{"tracking", "height 20.00 m", "sink rate 1.25 m/s",
                                                  "approach 3.00 deg", "protection level 0.50 m"}));
  landing.height_valid = false;
  EXPECT_EQ(linesFor(), (std::vector<std::string>{"tracking, not valid", "height -", "sink rate -",
                                                  "approach 3.00 deg", "protection level 0.50 m"}));
  landing.height_valid = true;
  landing.angle_valid = false;
  EXPECT_EQ(linesFor(),
            (std::vector<std::string>{"tracking, not valid", "height 20.00 m", "sink rate 1.25 m/s",
                                      "approach -", "protection level 0.50 m"}));
}

TEST(LandingMarkers, TheAircraftIsDrawnNoseFirst) {
  // 20 m high: the wings span 12 m. The nose is 0.45 spans ahead, the fin 0.16 above.
  const Eigen::AlignedBox3d box = boxOf(named(draw({}, {0.3, 0.05, 0.02}), "aircraft"));
  EXPECT_NEAR(box.max().x(), -100 + 0.45 * 12, 1e-6);
  EXPECT_NEAR(box.min().x(), -100 - 0.5 * 12, 1e-6);
  EXPECT_NEAR(box.max().y(), 1 + 6, 1e-6);
  EXPECT_NEAR(box.min().y(), 1 - 6, 1e-6);
  EXPECT_NEAR(box.max().z(), 20 + 0.16 * 12, 1e-6);
  EXPECT_NEAR(box.min().z(), 20, 1e-6);
}

TEST(LandingMarkers, DashesDoNotMoveWithTheMeasuredWidth) {
  const auto dashes = [](double width) {
    for (const auto& marker : draw({}, {0.3, 0.05, 0.02}, width).markers)
      if (marker.ns == "runway" && marker.type == visualization_msgs::Marker::LINE_LIST) return marker.points;
    throw std::runtime_error("no dashes");
  };
  EXPECT_GT(dashes(43.6).size(), 4u);
  EXPECT_EQ(dashes(43.6), dashes(43.7));
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
  const auto lost = drawLanding({}, {}, estimate(), std::nullopt, {1, 0}, {}, kUnknown).markers;
  for (const char* name : {"aircraft", "glide_path", "uncertainty"}) {
    EXPECT_EQ(named(drawn, name).action, visualization_msgs::Marker::ADD) << name;
    EXPECT_EQ(named(lost, name).action, visualization_msgs::Marker::DELETE) << name;
    EXPECT_EQ(named(lost, name).id, named(drawn, name).id) << name;
  }
}

TEST(LandingMarkers, WithoutAnAircraftRunwayPathAndNumbersAreLeft) {
  const auto array =
      drawLanding({}, {}, estimate(), std::nullopt, {1, 0}, {{0, 0, 3}, {1, 0, 2}}, kUnknown).markers;
  std::multiset<std::string> shown, removed;
  for (const auto& marker : array.markers)
    (marker.action == visualization_msgs::Marker::ADD ? shown : removed).insert(marker.ns);
  EXPECT_EQ(shown, (std::multiset<std::string>{"numbers", "path", "runway", "runway", "runway"}));
  EXPECT_EQ(removed, (std::multiset<std::string>{"aircraft", "glide_path", "uncertainty"}));
  EXPECT_EQ(named(array, "path").points.size(), 2u);
  EXPECT_NE(named(array, "numbers").text.find("height 20.00 m"), std::string::npos);
}

/// The 3D pane of rviz with the layout that is installed, as wide as it is there.
class LandingView : public testing::Test {
 protected:
  static constexpr double kPaneHeight = 800, kPaneWidth = 680;  // pixels
  static constexpr double kHalfOpening = M_PI / 8;              // rviz', of the pane's height

  /// Right and down from the pane's upper left corner, pixels.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    const Eigen::Matrix3d runway_from_view =
        (Eigen::AngleAxisd(view_["Yaw"].as<double>(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(view_["Pitch"].as<double>(), Eigen::Vector3d::UnitY()))
            .toRotationMatrix();
    const auto& place = scene_.view.transform.translation;
    const Eigen::Vector3d seen =
        runway_from_view.transpose() * (point - Eigen::Vector3d(place.x, place.y, place.z));
    EXPECT_GT(seen.x(), view_["Near Clip Distance"].as<double>());
    return Eigen::Vector2d(kPaneWidth, kPaneHeight) / 2 -
           Eigen::Vector2d(seen.y(), seen.z()) / seen.x() * kPaneHeight / 2 / std::tan(kHalfOpening);
  }

  /// Of the text: letters are about half as wide as high, lines as far apart as letters are high.
  Eigen::AlignedBox2d textBox() const {
    const auto& text = named(scene_.markers, "numbers");
    size_t longest = 0;
    const std::vector<std::string> lines = linesOf(text.text);
    for (const std::string& line : lines) longest = std::max(longest, line.size());
    const Eigen::Vector2d middle = project(vector(text.pose.position));
    const double letter =
        middle.y() - project(vector(text.pose.position) + Eigen::Vector3d(0, 0, text.scale.z)).y();
    EXPECT_GE(letter, 20) << "too small to be read";
    const Eigen::Vector2d half =
        letter / 2 * Eigen::Vector2d(0.5 * static_cast<double>(longest), static_cast<double>(lines.size()));
    return {middle - half, middle + half};
  }

  void expectInPane(const Eigen::AlignedBox2d& box, const std::string& what) const {
    EXPECT_TRUE(pane_.contains(box)) << what << " from " << box.min().transpose() << " to "
                                     << box.max().transpose();
  }

  const YAML::Node view_ = YAML::LoadFile(UAV_LANDING_SOURCE_DIR
                                          "/rviz/landing.rviz")["Visualization Manager"]["Views"]["Current"];
  const Eigen::AlignedBox2d pane_{Eigen::Vector2d::Zero(), Eigen::Vector2d(kPaneWidth, kPaneHeight)};
  LandingScene scene_;
};

TEST_F(LandingView, FollowsTheFrameThatIsDrawn) {
  scene_ = drawLanding({}, {}, estimate(), std::nullopt, {1, 0}, {}, kUnknown);
  EXPECT_EQ(view_["Target Frame"].as<std::string>(), scene_.view.child_frame_id);
  EXPECT_EQ(view_["Class"].as<std::string>(), "rviz/FPS");
}

TEST_F(LandingView, ShowsAircraftAndNumbersThroughoutAnApproach) {
  struct Case {
    double width, x, height;
  };
  for (const Case& c : {Case{1.2, -4.4, 2}, Case{1.2, 2, 0.6}, Case{kUnknown, -4.4, 1.5}, Case{43.6, -80, 17},
                        Case{43.6, 200, 1.7}, Case{45, -800, 40}, Case{60, -3000, 150}}) {
    SCOPED_TRACE(std::to_string(c.height) + " m");
    const DrawnAircraft aircraft{{c.x, 0, c.height}, {2, 0.1, 0.05}, straightAhead()};
    scene_ = drawLanding({}, {}, estimate(), aircraft, {1, 0}, {}, c.width);
    const Eigen::AlignedBox2d text = textBox();
    expectInPane(text, "text");
    Eigen::AlignedBox2d shape;
    for (const auto& p : named(scene_.markers, "aircraft").points) shape.extend(project(vector(p)));
    for (const auto& p : named(scene_.markers, "uncertainty").points) shape.extend(project(vector(p)));
    expectInPane(shape, "aircraft");
    EXPECT_GE(shape.sizes().x(), 80) << "pixels of wing span";
    EXPECT_FALSE(shape.intersects(text));
  }
}

TEST_F(LandingView, ShowsTheWholeReasonWhereNothingIsKnown) {
  LandingResult lost;
  lost.status = Status::kLost;
  lost.failure = {Reason::kTransformMissing,
                  "no static transform between a_frame_with_a_name_of_some_length and "
                  "an_aircraft/left_camera_optical_frame, nor any other"};
  for (const auto& track : {std::deque<Eigen::Vector3d>{}, std::deque<Eigen::Vector3d>{{-200, 3, 20}}}) {
    scene_ = drawLanding({}, {}, lost, std::nullopt, {1, 0}, track, kUnknown);
    expectInPane(textBox(), "text");
  }
}

TEST_F(LandingView, BreaksLinesAtSpacesOnly) {
  LandingResult lost;
  lost.failure = {Reason::kTimeout, "no image pair yet, see the log of rectify"};
  scene_ = drawLanding({}, {}, lost, std::nullopt, {1, 0}, {}, kUnknown);
  std::string text = named(scene_.markers, "numbers").text;
  for (const std::string& line : linesOf(text)) EXPECT_LE(line.size(), 42u) << line;
  std::replace(text.begin(), text.end(), '\n', ' ');
  EXPECT_NE(text.find(lost.failure.message()), std::string::npos) << text;
}

}  // namespace
}  // namespace uav_landing
