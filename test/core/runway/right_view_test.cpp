#include "runway/direction/right_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using namespace test;

/// A camera of the rig at a pose: where it sees points of the world.
struct Camera {
  Eigen::Matrix3d K, optical_from_world;
  Eigen::Vector3d centre;

  Eigen::Vector2d pixel(const Eigen::Vector3d& X) const {
    return (K * (optical_from_world * (X - centre))).hnormalized();
  }
};

struct Scene {
  StereoRig rig = makeRig(640, 480, 0.5);
  Pose pose = makePose(3, -8, 6);
  SeenGround ground{exactPlane(pose, 0.001, 0.001), {}};

  Camera left() const { return {rig.K(), pose.worldFromOptical().transpose(), pose.position}; }
  /// turn: rotation vector of the camera against the rig.
  Camera right(const Eigen::Vector3d& turn = Eigen::Vector3d::Zero()) const {
    const Eigen::Matrix3d rotation =
        turn.isZero() ? Eigen::Matrix3d::Identity()
                      : Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    Eigen::Matrix3d K = rig.K();
    K(0, 2) = rig.cx_right;
    return {K, rotation.transpose() * pose.worldFromOptical().transpose(),
            pose.position + pose.worldFromOptical() * Eigen::Vector3d(rig.baseline, 0, 0)};
  }
};

/// An edge on the ground from a to b with its brighter side to the left of that way, as a camera sees it.
LineSegment seen(const Camera& camera, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector2d p = camera.pixel(a), q = camera.pixel(b);
  const Eigen::Vector3d bright = 0.5 * (a + b) + Eigen::Vector3d(a.y() - b.y(), b.x() - a.x(), 0) * 0.01;
  const Eigen::Vector2d along = (q - p).normalized();
  Eigen::Vector2d across(-along.y(), along.x());
  if (across.dot(camera.pixel(bright) - p) < 0) across = -across;
  return {p, q, {across.x(), across.y(), -across.dot(p)}, 0.05, 0.001};
}

const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> kEdges{{{9, 2, 0}, {60, 2.5, 0}},
                                                                      {{8, -3, 0}, {90, -3, 0}},
                                                                      {{40, -3, 0}, {12, -1, 0}},
                                                                      {{20, 4, 0}, {20, -4, 0}}};

TEST(RightView, SeesTheLinesOfTheGroundWhereThePlaneSays) {
  const Scene scene;
  for (const auto& [a, b] : kEdges) {
    const RoughSegment moved = linesInRightView(scene.rig, scene.ground, {seen(scene.left(), a, b)}).front();
    const LineSegment wanted = seen(scene.right(), a, b);
    EXPECT_LT((moved.a - wanted.a).norm(), 1e-6);
    EXPECT_LT((moved.b - wanted.b).norm(), 1e-6);
    EXPECT_GT(moved.brighter.dot(wanted.line.head<2>()), 0);
  }
}

TEST(RightView, FollowsTheRotationThatVerticalDisparitiesTell) {
  Scene scene;
  const Eigen::Vector3d turn(0.006, 0, -0.004);
  const auto furthest = [&] {
    double miss = 0;
    for (const auto& [a, b] : kEdges) {
      const RoughSegment moved =
          linesInRightView(scene.rig, scene.ground, {seen(scene.left(), a, b)}).front();
      const Camera right = scene.right(turn);
      miss = std::max(
          {miss, std::abs(moved.a.y() - right.pixel(a).y()), std::abs(moved.b.y() - right.pixel(b).y())});
    }
    return miss;
  };
  EXPECT_GT(furthest(), 2.5);
  scene.ground.rows = {turn, Eigen::Matrix3d::Identity() * 1e-8, 100};
  EXPECT_LT(furthest(), 0.1);
}

}  // namespace
}  // namespace uav_landing
