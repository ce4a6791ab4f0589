#include "uav_landing/runway/runway_direction.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Pose;

struct Scene {
  StereoRig rig = test::makeRig(480, 360, 0.65);
  RigModel model = test::makeModel(rig);
  GroundRenderer ground{61};
  ApproachAngleParameters parameters;
  Pose pose;
  cv::Mat left, right;

  Scene() {
    ground.contrast = 2;
    ground.line_offset = 1.1;
    ground.line_width = 0.12;
    pose.position = {0, 0.2, 1.7};
    pose.pitch = -6 * kDegree;
    pose.roll = 3 * kDegree;
    pose.yaw = -4 * kDegree;
    left = ground.left(rig, pose);
    right = ground.right(rig, pose);
  }

  RunwayDirection find(bool with_normal) {
    Timings timings;
    const GroundPlane plane{pose.down() / pose.height(), Eigen::Matrix3d::Identity() * 1e-8};
    return findRunwayDirection(rig, left, right, model.left_mask, model.right_mask,
                               with_normal ? &plane : nullptr, parameters, timings);
  }
  /// The runway runs along x.
  double error(const Eigen::Vector3d& direction) const {
    return direction.cross(pose.seen(Eigen::Vector3d::UnitX())).norm();
  }
};

TEST(RunwayDirection, IsThatOfThePaintedLinesInBothViewsAndTogether) {
  for (const bool with_normal : {true, false}) {
    Scene scene;
    const RunwayDirection found = scene.find(with_normal);
    ASSERT_TRUE(found.combined) << found.combined.error().message();
    EXPECT_LT(scene.error(found.left.vanishing_direction), 0.2 * kDegree);
    // The right view has its own principal point; rays are those of one common frame all the same.
    EXPECT_LT(scene.error(found.right.vanishing_direction), 0.2 * kDegree);
    EXPECT_LT(scene.error(found.combined->direction), 0.15 * kDegree);
    EXPECT_NEAR(found.combined->direction.norm(), 1, 1e-9);
  }
}

TEST(RunwayDirection, LooksBelowTheHorizonOnlyWhenTheGroundIsKnown) {
  Scene scene;
  // A fan of strong edges in the sky that meet 25 degrees to the left of the runway, above the horizon.
  for (cv::Mat* image : {&scene.left, &scene.right})
    for (int x = -150; x <= 420; x += 57) cv::line(*image, {60, 110}, {x, 0}, cv::Scalar(20), 2, cv::LINE_AA);
  const RunwayDirection found = scene.find(true);
  ASSERT_TRUE(found.combined) << found.combined.error().message();
  EXPECT_LT(scene.error(found.combined->direction), 0.15 * kDegree);
  for (const ApproachAngleResult::Line& line : found.left.lines) {
    const Eigen::Vector2d middle = 0.5 * (line.a + line.b);
    EXPECT_GT(scene.pose.down().dot(scene.rig.ray(middle.x(), middle.y())), 0);
  }
}

TEST(RunwayDirection, ComesFromOneViewWhenTheOtherSeesNothing) {
  Scene scene;
  scene.right.setTo(cv::Scalar(100));
  const RunwayDirection found = scene.find(true);
  EXPECT_FALSE(found.left.failure);
  EXPECT_TRUE(found.right.failure);
  EXPECT_FALSE(found.right.vanishing_direction.allFinite());
  ASSERT_TRUE(found.combined);
  EXPECT_LT(scene.error(found.combined->direction), 0.2 * kDegree);
}

TEST(RunwayDirection, LooksInsideTheMasksOnly) {
  Scene scene;
  scene.model.left_mask = 0;
  scene.model.right_mask = 0;
  const RunwayDirection found = scene.find(true);
  EXPECT_TRUE(found.left.lines.empty() && found.right.lines.empty());
  EXPECT_FALSE(found.combined);
}

TEST(RunwayDirection, IsNoneWithoutLinesAndSaysWhy) {
  Scene scene;
  scene.left.setTo(cv::Scalar(100));
  scene.right.setTo(cv::Scalar(100));
  const RunwayDirection found = scene.find(true);
  ASSERT_FALSE(found.combined);
  EXPECT_TRUE(found.combined.error().reason == Reason::kTooFewFeatures ||
              found.combined.error().reason == Reason::kNoVanishingPoint)
      << found.combined.error().message();
  EXPECT_FALSE(found.combined.error().detail.empty());
}

}  // namespace
}  // namespace uav_landing
