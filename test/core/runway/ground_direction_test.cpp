#include "runway/direction/ground_direction.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::Pose;

const Eigen::Matrix3d kCovariance = Eigen::Matrix3d::Identity() * std::pow(0.02 * kDegree, 2);

/// A camera 14 m up, 120 m before a runway of 45 m, that looks a little aside.
struct Scene {
  StereoRig rig = test::makeRig(640, 480, 1.0);
  Pose pose;
  std::vector<LineSegment> left, right;

  Scene() {
    pose.position = {-120, 2, 14};
    pose.yaw = 6 * kDegree;
    pose.pitch = -5 * kDegree;
    pose.roll = 5 * kDegree;
  }
  LineSegment line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool is_left) const {
    const auto pixel = [&](const Eigen::Vector2d& point) -> Eigen::Vector2d {
      Eigen::Vector3d seen = pose.seen(Eigen::Vector3d(point.x(), point.y(), 0) - pose.position);
      if (!is_left) seen.x() -= rig.baseline;
      return {rig.fx * seen.x() / seen.z() + (is_left ? rig.cx : rig.cx_right),
              rig.fy * seen.y() / seen.z() + rig.cy};
    };
    const Eigen::Vector2d a = pixel(from), b = pixel(to), along = (b - a).normalized();
    const Eigen::Vector2d normal(along.y(), -along.x());
    return {a, b, {normal.x(), normal.y(), -normal.dot(a)}, 0.05, 0.05 * std::sqrt(12.0) / (b - a).norm()};
  }
  void add(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    left.push_back(line(from, to, true));
    right.push_back(line(from, to, false));
  }
  std::optional<LinesAlong> find() const { return find(pose.down(), kCovariance); }
  std::optional<LinesAlong> find(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance) const {
    Eigen::Matrix3d K_right = rig.K();
    K_right(0, 2) = rig.cx_right;
    return findLinesAlong({{left, rig.K()}, {right, K_right}}, normal, covariance, 30 * kDegree);
  }
};

TEST(GroundDirection, TwoLongEdgesSideBySideAreEnough) {
  Scene scene;
  scene.add({0, 22}, {400, 22});
  scene.add({-20, 60}, {-18, -40});  // across
  scene.add({0, -22}, {500, -22});
  const auto along = scene.find();
  ASSERT_TRUE(along);
  for (const std::vector<char>& view : *along) EXPECT_EQ(view, (std::vector<char>{1, 0, 1}));
}

TEST(GroundDirection, OneEdgeIsNot) {
  Scene scene;
  scene.add({0, 22}, {400, 22});
  scene.add({0, 22.01}, {300, 22.01});
  EXPECT_FALSE(scene.find());
}

TEST(GroundDirection, ShortLinesSayNothingHoweverMany) {
  Scene scene;
  for (double y = -30; y < 30; y += 4) scene.add({0, y}, {20, y});
  EXPECT_FALSE(scene.find());
}

TEST(GroundDirection, TwoDirectionsAreNotDecided) {
  Scene scene;
  for (const double y : {-22, 22}) {
    scene.add({0, y}, {400, y});
    scene.add({0, y}, {400, y + 60});
  }
  EXPECT_FALSE(scene.find());
}

// A normal that is wrong makes two edges diverge. Whether it may be that wrong, its pitch and roll tell
// together: here it is uncertain in one direction only, half ahead and half aside.
TEST(GroundDirection, EdgesMayDivergeAsFarAsTheNormalsErrorsMakeThemTogether) {
  Scene scene;
  scene.pose.yaw = 25 * kDegree;
  scene.add({0, 22}, {400, 22});
  scene.add({0, -22}, {500, -22});
  const Eigen::Vector3d n = scene.pose.down(), runway = scene.pose.seen(Eigen::Vector3d::UnitX());
  const Eigen::Vector3d ahead = (Eigen::Vector3d::UnitZ() - n.z() * n).normalized(), left = ahead.cross(n);
  const Eigen::Vector3d tip = (runway.dot(left) * ahead + runway.dot(ahead) * left).normalized();
  constexpr double kTip = 1.5 * kDegree;
  const Eigen::Vector3d wrong = (n + kTip * tip).normalized();
  EXPECT_FALSE(scene.find(wrong, kCovariance)) << "wrong by far more than it claims";
  EXPECT_TRUE(scene.find(wrong, kTip * kTip * tip * tip.transpose() + kCovariance));
}

}  // namespace
}  // namespace uav_landing
