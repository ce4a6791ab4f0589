#include "geometry/stamp_map.h"

#include <gtest/gtest.h>

#include "support/rolling_camera.h"

namespace uav_landing {
namespace {

constexpr double kReadout = 0.03;  // s

struct Scene {
  test::Pose (*poseAt)(double) = test::movingPose;
  StereoRig rig = test::makeRig(640, 480, 1);
  RowTimes times{test::calibrationOf(rig), {kReadout, 0.5}};
  test::Pose now = poseAt(0);
  StampMap map{rig.K(), times, test::motionAt(0, poseAt), now.down()};

  Eigen::Vector2d seen(const Eigen::Vector3d& world) const {
    return test::rollingPixel(poseAt, rig, 0, kReadout, world);
  }
  Eigen::Vector3d onGround(double u, double v) const {
    const Eigen::Vector3d ray = now.worldFromOptical() * rig.ray(u, v);
    return now.position - ray * now.position.z() / ray.z();
  }
};

TEST(StampMap, LeadsGroundFromItsRowToTheStampAndBack) {
  const Scene scene;
  for (const double u : {30.0, 320.0, 610.0})
    for (const double v : {250.0, 350.0, 470.0}) {
      const Eigen::Vector2d truth(u, v), seen = scene.seen(scene.onGround(u, v));
      EXPECT_LT((scene.map.toStamp(seen) - truth).norm(), 0.02) << u << ' ' << v;
      EXPECT_LT((scene.map.toRow(truth) - seen).norm(), 0.02) << u << ' ' << v;
      if (v > 400) {
        EXPECT_GT((seen - truth).norm(), 5) << "the shutter must matter";
      }
    }
}

TEST(StampMap, LeadsPointsOffTheGroundByTheirDepth) {
  const Scene scene;
  const Eigen::Vector2d pixel(500, 400);
  const double depth = 2.5;  // m
  const Eigen::Vector3d world =
      scene.now.position + scene.now.worldFromOptical() * (depth * scene.rig.ray(pixel.x(), pixel.y()));
  const Eigen::Vector2d seen = scene.seen(world);
  const double inverse_depth = scene.now.height() / depth;
  EXPECT_LT((scene.map.toRow(pixel, inverse_depth) - seen).norm(), 0.02);
  // By the depth that it has at its row, which stereo measures there.
  const double t = scene.times.at(seen.x(), seen.y());
  const test::Pose then = test::movingPose(t);
  const double then_depth = then.seen(world - then.position).z();
  EXPECT_LT((scene.map.toStamp(seen, scene.now.height() / then_depth) - pixel).norm(), 0.02);
}

TEST(StampMap, TurnsWhatIsAboveTheHorizon) {
  const Scene scene;
  const Eigen::Vector2d pixel(100, 20);
  const Eigen::Vector3d far =
      scene.now.position + 1e7 * (scene.now.worldFromOptical() * scene.rig.ray(pixel.x(), pixel.y()));
  EXPECT_LT((scene.map.toStamp(scene.seen(far)) - pixel).norm(), 0.01);
  EXPECT_LT((scene.map.toRow(pixel) - scene.seen(far)).norm(), 0.01);
}

/// The camera in a gust that rolls it faster and faster.
test::Pose gustPose(double t) {
  test::Pose pose = test::movingPose(t);
  pose.roll += 100 * test::kDegree * t * t;
  return pose;
}

TEST(StampMap, FollowsATurnThatGetsFaster) {
  Scene scene;
  scene.poseAt = gustPose;
  RowMotion motion = test::motionAt(0, gustPose);
  const StampMap even(scene.rig.K(), scene.times, motion, scene.now.down());
  constexpr double kApart = 1e-3;
  motion.a = (test::motionAt(kApart, gustPose).w - test::motionAt(-kApart, gustPose).w) / (2 * kApart);
  const StampMap map(scene.rig.K(), scene.times, motion, scene.now.down());
  for (const double u : {30.0, 610.0})
    for (const double v : {250.0, 470.0}) {
      const Eigen::Vector2d truth(u, v), seen = scene.seen(scene.onGround(u, v));
      EXPECT_LT((map.toStamp(seen) - truth).norm(), 0.02) << u << ' ' << v;
      EXPECT_LT((map.toRow(truth) - seen).norm(), 0.02) << u << ' ' << v;
      if (v > 400) {
        EXPECT_GT((even.toStamp(seen) - truth).norm(), 0.05) << "the gust must matter";
      }
    }
}

TEST(StampMap, ChangesNothingWithoutRowTimes) {
  const Scene scene;
  const Eigen::Vector2d pixel(100.25, 420.5);
  const RowTimes at_once;
  for (const StampMap& map :
       {StampMap(), StampMap(scene.rig.K(), at_once, test::motionAt(0), scene.now.down())}) {
    EXPECT_TRUE(map.changesNothing());
    EXPECT_EQ(map.toStamp(pixel), pixel);
    EXPECT_EQ(map.toRow(pixel), pixel);
    EXPECT_EQ(map.timeOf({0, 1, 3}), 0);
  }
}

TEST(StampMap, SaysWhereAPointIsWhenItsRowIsExposed) {
  const Scene scene;
  const Eigen::Vector3d world = scene.onGround(500, 420);
  const Eigen::Vector3d point = scene.now.seen(world - scene.now.position) / scene.now.height();
  const double seconds = scene.map.timeOf(point);
  EXPECT_NEAR(seconds, scene.times.at(scene.seen(world).x(), scene.seen(world).y()), 1e-5);
  EXPECT_LT((scene.rig.project(scene.map.pointAfter(seconds, point)) - scene.seen(world)).norm(), 0.02);
}

TEST(PlaneRate, IsThatOfThePlanesThatTheCameraHas) {
  constexpr double kStep = 1e-4;
  const auto plane = [](double t) -> Eigen::Vector3d {
    const test::Pose pose = test::movingPose(t);
    return pose.down() / pose.height();
  };
  const Eigen::Vector3d truth = (plane(kStep) - plane(-kStep)) / (2 * kStep);
  EXPECT_LT((planeRate(PlaneVector(plane(0)), test::motionAt(0)) - truth).norm(), 1e-4 * truth.norm());
}

}  // namespace
}  // namespace uav_landing
