#include "runway/direction/ground_edges.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/ground_line.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::Pose;

const Eigen::Matrix3d kExact = Eigen::Matrix3d::Identity() * 1e-12;

Pose banked() {
  Pose pose;
  pose.position = {0, 1.5, 8};
  pose.yaw = 7 * kDegree;
  pose.pitch = -5 * kDegree;
  pose.roll = -9 * kDegree;
  return pose;
}

GroundAxes axesOf(const Pose& pose) {
  // The direction of the vanishing point need not lie in the ground exactly.
  const Eigen::Vector3d direction = (pose.seen(Eigen::Vector3d::UnitX()) + 0.01 * pose.down()).normalized();
  return GroundAxes(pose.down(), kExact, direction, kExact);
}

TEST(GroundAxes, MeetTheGroundWhereTheRayDoes) {
  const Pose pose = banked();
  const GroundAxes axes = axesOf(pose);
  const Eigen::Vector2d met = axes.meet(pose.seen(Eigen::Vector3d(40, -3, 0) - pose.position));
  EXPECT_NEAR(met.x(), 40.0 / 8, 1e-9);
  EXPECT_NEAR(met.y(), (-3 - 1.5) / 8, 1e-9);
}

TEST(GroundAxes, ErrorsOfTheNormalMoveThePointAsTheyClaim) {
  const Pose pose = banked();
  const GroundAxes axes = axesOf(pose);
  const Eigen::Vector3d ray = pose.seen(Eigen::Vector3d(40, -13, 0) - pose.position);
  const Eigen::Vector2d met = axes.meet(ray);
  for (const Eigen::Vector3d& tip : {axes.left, axes.forward}) {
    const double size = 1e-4;
    const GroundAxes tipped((axes.down + size * tip).normalized(), kExact, axes.forward, kExact);
    const GroundAxes claimed(axes.down, size * size * tip * tip.transpose(), axes.forward,
                             Eigen::Matrix3d::Zero());
    const Eigen::Matrix<double, 2, 3> by_rotation = GroundAxes::meetByRotation(met);
    const Eigen::Matrix2d covariance = by_rotation * claimed.covariance * by_rotation.transpose();
    const Eigen::Vector2d moved = tipped.meet(ray) - met;
    EXPECT_NEAR(std::sqrt(covariance(0, 0)), std::abs(moved.x()), 0.02 * moved.norm());
    EXPECT_NEAR(std::sqrt(covariance(1, 1)), std::abs(moved.y()), 0.02 * moved.norm());
  }
}

TEST(GroundEdges, HaveTheLateralPositionOfTheLineInBothViews) {
  const StereoRig rig = test::makeRig(640, 480, 1.0);
  const Pose pose = banked();
  const GroundAxes axes = axesOf(pose);
  for (const double y : {-6.0, 0.4, 9.0}) {
    for (const bool right : {false, true}) {
      const LineSegment line = test::groundLine(rig, pose, y, 25, 90, right ? rig.baseline : 0, y < 0);
      const auto edges =
          groundEdges(rig, axes, {line}, {1}, {right ? rig.cx_right : rig.cx, right ? rig.baseline / 8 : 0});
      ASSERT_EQ(edges.size(), 1u);
      EXPECT_NEAR(edges[0].lateral, (y - 1.5) / 8, 1e-6);
      EXPECT_EQ(edges[0].brighter_left, y < 0);
      EXPECT_NEAR(edges[0].extent, std::log(90.0 / 25), 0.02);
    }
  }
}

TEST(GroundEdges, JoinThePiecesOfOneEdgeButNotTheTwoSidesOfAStripe) {
  const StereoRig rig = test::makeRig(640, 480, 1.0);
  const Pose pose = banked();
  const auto edges =
      groundEdges(rig, axesOf(pose),
                  {test::groundLine(rig, pose, 2, 25, 40, 0, true), groundLine(rig, pose, 2, 50, 80, 0, true),
                   test::groundLine(rig, pose, 2, 25, 40, 0, false)},
                  {1, 1, 1}, {rig.cx});
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_NEAR(edges[0].extent, std::log(40.0 / 25) + std::log(80.0 / 50), 0.03);
}

TEST(GroundEdges, AShortPieceBelongsToTheLongEdgeInWhateverOrderTheyCome) {
  const StereoRig rig = test::makeRig(640, 480, 1.0);
  const Pose pose = banked();
  const auto lineAt = [&](double y, double from, double to, double offset_stddev) {
    LineSegment line = test::groundLine(rig, pose, y, from, to, 0, true);
    line.offset_stddev = offset_stddev;
    return line;
  };
  const auto edgesOf = [&](const std::vector<LineSegment>& lines) {
    return groundEdges(rig, axesOf(pose), lines, std::vector<char>(lines.size(), 1), {rig.cx});
  };
  const double stddev = 8 * std::sqrt(edgesOf({lineAt(2, 30, 40, 2)}).front().variance);  // m
  // A piece of the long edge that is off by 2 sigma, and one of another edge, 4 sigma from the long one.
  const std::vector<LineSegment> lines{lineAt(2, 25, 90, 0.01), lineAt(2 + 2 * stddev, 30, 36, 2),
                                       lineAt(2 + 4 * stddev, 30, 40, 2)};
  std::array<int, 3> order{0, 1, 2};
  do {
    const auto edges = edgesOf({lines[order[0]], lines[order[1]], lines[order[2]]});
    ASSERT_EQ(edges.size(), 2u);
    EXPECT_NEAR(8 * edges[0].lateral + 1.5, 2, 0.1 * stddev);
    EXPECT_NEAR(8 * edges[1].lateral + 1.5, 2 + 4 * stddev, 0.1 * stddev);
    EXPECT_EQ(edges[0].pieces.size(), 2u);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(GroundEdges, PiecesFarAsideMayBeFartherApart) {
  const StereoRig rig = test::makeRig(640, 480, 1.0);
  const Pose pose = banked();
  // Lines that are known exactly, so what is left is 0.3 % of the distance from the camera: 8 m above, and
  // so far aside.
  const auto count = [&](double aside, double apart) {
    std::vector<LineSegment> lines{test::groundLine(rig, pose, 1.5 + aside, 60, 75, 0, true),
                                   test::groundLine(rig, pose, 1.5 + aside + apart, 80, 95, 0, true)};
    for (LineSegment& line : lines) line.offset_stddev = line.angle_stddev = 1e-9;
    return groundEdges(rig, axesOf(pose), lines, {1, 1}, {rig.cx}).size();
  };
  EXPECT_EQ(count(0, 0.02), 1u);
  EXPECT_EQ(count(0, 0.05), 2u);
  EXPECT_EQ(count(24, 0.05), 1u) << "25 m from the camera";
  EXPECT_EQ(count(24, 0.12), 2u);
}

TEST(GroundEdges, ALineThatReachesTheHorizonOrLiesBehindIsNone) {
  const StereoRig rig = test::makeRig(640, 480, 1.0);
  const Pose pose = banked();
  const auto count = [&](double y, double far) {
    LineSegment line = test::groundLine(rig, pose, y, 25, 90, 0, true);
    // Beyond the horizon by this share of its length.
    line.b = line.a + far * (line.b - line.a);
    return groundEdges(rig, axesOf(pose), {line}, {1}, {rig.cx}).size();
  };
  EXPECT_EQ(count(2, 1), 1u);
  // 25 m ahead the line is 8 m / 25 m below the horizon, 90 m ahead 8 m / 90 m.
  EXPECT_EQ(count(2, 1.3), 1u);
  EXPECT_EQ(count(2, 1.5), 0u);
  // So flat that nobody can tell how far away the end is: 8 m below over 16 km.
  const auto countTo = [&](double far) {
    const LineSegment line = test::groundLine(rig, pose, 2, 25, far, 0, true);
    return groundEdges(rig, axesOf(pose), {line}, {1}, {rig.cx}).size();
  };
  EXPECT_EQ(countTo(1000), 1u);
  EXPECT_EQ(countTo(16000), 0u);
  LineSegment above = test::groundLine(rig, pose, 2, 25, 90, 0, true);
  std::swap(above.a, above.b);
  above.a = above.b + 1.5 * (above.a - above.b);
  EXPECT_TRUE(groundEdges(rig, axesOf(pose), {above}, {1}, {rig.cx}).empty()) << "by its first end";
}

TEST(GroundEdges, WhatStandsAboveTheGroundMatchesInNoOtherView) {
  const StereoRig rig = test::makeRig(640, 480, 1.0);
  const Pose pose = banked();
  const GroundAxes axes = axesOf(pose);
  Pose from_above = pose;  // the edge of a roof 2 m up is seen as from a camera 2 m lower
  from_above.position.z() -= 2;
  const auto view = [&](bool right, const Pose& edge_pose) {
    return groundEdges(rig, axes,
                       {test::groundLine(rig, edge_pose, 9, 25, 90, right ? rig.baseline : 0, true)}, {1},
                       {right ? rig.cx_right : rig.cx, right ? rig.baseline / 8 : 0});
  };
  EXPECT_EQ(matchEdges(axes, view(false, pose), view(true, pose)).size(), 1u);
  EXPECT_TRUE(matchEdges(axes, view(false, from_above), view(true, from_above)).empty());
}

TEST(GroundEdges, AreTheLongestFirstOfOneViewAndOfBoth) {
  const StereoRig rig = test::makeRig(640, 480, 1.0);
  const Pose pose = banked();
  const GroundAxes axes = axesOf(pose);
  // Each view sees one edge that the other does not.
  const auto edgesOf = [&](bool right) {
    const double offset = right ? rig.baseline : 0;
    return groundEdges(rig, axes,
                       {test::groundLine(rig, pose, 0.4, 25, 40, offset, true),
                        groundLine(rig, pose, 2, 25, 60, offset, true),
                        test::groundLine(rig, pose, right ? -6 : 9, 25, right ? 50 : 90, offset, true)},
                       {1, 1, 1}, {right ? rig.cx_right : rig.cx, right ? rig.baseline / 8 : 0});
  };
  const auto lateralsOf = [](const std::vector<GroundEdge>& edges) {
    std::vector<double> places;  // across, m
    for (const GroundEdge& edge : edges) places.push_back(std::round(80 * edge.lateral + 15) / 10);
    return places;
  };
  const std::vector<GroundEdge> left = edgesOf(false), right = edgesOf(true);
  EXPECT_EQ(lateralsOf(left), (std::vector<double>{9, 2, 0.4}));
  EXPECT_EQ(lateralsOf(right), (std::vector<double>{2, -6, 0.4}));
  EXPECT_EQ(lateralsOf(joinEdges(axes, left, right)), (std::vector<double>{9, 2, -6, 0.4}));
  EXPECT_EQ(lateralsOf(matchEdges(axes, left, right)), (std::vector<double>{2, 0.4}));
}

}  // namespace
}  // namespace uav_landing
