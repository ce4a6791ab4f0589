#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "support/approach_scene.h"
#include "uav_landing/stages/approach_angle_stage.h"

namespace uav_landing {
namespace {

using namespace test;

TEST(ApproachAngleNormal, WorksWithoutStereoFromPaintedLines) {
  ApproachScene scene(34);
  scene.parameters.use_stereo = false;
  scene.ground.contrast = 8;
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  constexpr int kFrames = 6;
  const std::vector<ApproachAngleResult> results = scene.run(path, kFrames);
  const ApproachAngleResult& last = results.back();
  ASSERT_FALSE(last.failure) << last.failure.message();
  const Pose now = path((kFrames - 1) * kPeriod);
  // The lines run along x.
  const Eigen::Vector3d wanted = now.seen(Eigen::Vector3d::UnitX());
  EXPECT_LT(std::acos(std::min(1.0, last.vanishing_direction.dot(wanted))), 0.5 * kDegree);
  EXPECT_LT(std::acos(std::min(1.0, last.n.dot(now.down()))), 2 * kDegree);
  const double stddev = std::sqrt(last.window.angle_variance);
  EXPECT_NEAR(last.window.angle, 10 * kDegree, 3.5 * stddev);
  EXPECT_LT(stddev, 1.5 * kDegree);
}

TEST(ApproachAngleNormal, SaysThatThereIsNoGroundNormalWithoutStereoAndLines) {
  ApproachScene scene(35);
  scene.parameters.use_stereo = false;
  scene.ground.line_offset = 0;
  scene.ground.contrast = 1.5;  // strong texture has streaks along the runway
  const std::vector<ApproachAngleResult> results = scene.run(straight(attitude(-8, 0, 0), 1.8, 1.4, 10), 3);
  EXPECT_EQ(results.back().failure.reason, Reason::kNoGroundNormal) << results.back().failure.message();
  EXPECT_TRUE(results.back().left.failure && results.back().right.failure);
}

TEST(ApproachAngleNormal, GivesTheDirectionOfTheRunwayInBothViews) {
  ApproachScene scene(36);
  scene.ground.contrast = 5;
  const auto path = straight(attitude(-7, 4, 5), 1.8, 1.4, 8);
  const ApproachAngleResult result = scene.run(path, 1).front();
  const Eigen::Vector3d wanted = path(0).seen(Eigen::Vector3d::UnitX());
  for (const ApproachAngleResult::View* view : {&result.left, &result.right}) {
    ASSERT_FALSE(view->failure) << view->failure.message();
    EXPECT_LT(std::acos(std::min(1.0, view->vanishing_direction.dot(wanted))), 0.3 * kDegree);
    EXPECT_GE(
        std::count_if(view->lines.begin(), view->lines.end(), [](const auto& line) { return line.inlier; }),
        scene.parameters.min_lines);
  }
  EXPECT_LT(std::acos(std::min(1.0, result.vanishing_direction.dot(wanted))), 0.3 * kDegree);
  const Eigen::Vector3d error = result.vanishing_direction - wanted;
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(error[i], 0, 4 * std::sqrt(result.vanishing_covariance(i, i)));
  // What the runway's own slope and curve turn it by is up and down: seen from above it is straight.
  const Eigen::Vector3d across = result.n.cross(result.vanishing_direction).normalized();
  const double straightness = std::pow(scene.parameters.runway_straightness_deg * kDegree, 2);
  EXPECT_LT(across.dot(result.vanishing_covariance * across), 0.5 * straightness);
  EXPECT_GT(result.n.dot(result.vanishing_covariance * result.n), 0.98 * straightness);
}

TEST(ApproachAngleNormal, CorrectsTheStereoNormalByTheVanishingPoint) {
  // Stereo that is wrong in pitch by one of its own sigma, of 0.3 degrees.
  ApproachScene scene(37);
  scene.ground.contrast = 5;
  const Pose pose = straight(attitude(-8, 0, 0), 1.8, 1.4, 10)(0);
  Pose believed = pose;
  believed.pitch += 0.3 * kDegree;
  StereoDepthResult stereo = scene.stereo(pose, 0);
  stereo.plane = exactPlane(believed, kHeightShare, 0.3 * kDegree);
  ApproachAngleStage stage(scene.model, scene.parameters);
  const ApproachAngleResult result =
      stage.process(0, scene.ground.left(scene.rig, pose), scene.ground.right(scene.rig, pose), stereo);
  ASSERT_TRUE(result.vanishing_direction.allFinite());
  EXPECT_LT(std::abs(pitchOf(result.n) - pose.pitch), 0.15 * kDegree);
}

/// What a perfect inertial sensor says, tipped by an error of pitch.
AttitudePrior inertial(const Pose& then, const Pose& now, double pitch_error = 0) {
  constexpr double kAttitude = 0.5 * kDegree, kRotation = 0.02 * kDegree;
  AttitudePrior prior;
  prior.failure = {};
  Pose tipped = now;
  tipped.pitch += pitch_error;
  prior.normal = tipped.down();
  prior.normal_covariance =
      kAttitude * kAttitude * (Eigen::Matrix3d::Identity() - prior.normal * prior.normal.transpose());
  const Eigen::AngleAxisd turn(Movement(then, now).R);
  prior.duration = kPeriod;
  prior.rotation = turn.angle() * turn.axis();
  prior.rotation_covariance = kRotation * kRotation * Eigen::Matrix3d::Identity();
  return prior;
}

TEST(ApproachAngleNormal, AnInertialSensorIsGroundNormalEnough) {
  // Neither stereo nor painted lines.
  ApproachScene scene(45);
  scene.parameters.use_stereo = false;
  scene.parameters.runway_slope_stddev_deg = 0.4;
  scene.ground.line_offset = 0;
  const auto path = straight(attitude(-8, 3, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage(scene.model, scene.parameters);
  ApproachAngleResult result;
  for (int i = 0; i < 3; ++i) {
    const Pose then = path((i - 1) * kPeriod), now = path(i * kPeriod);
    result = stage.process(i * kPeriod, scene.ground.left(scene.rig, now), scene.ground.right(scene.rig, now),
                           {}, inertial(then, now));
  }
  EXPECT_FALSE(result.failure) << result.failure.message();
  EXPECT_NEAR(result.step.angle, 10 * kDegree, 0.5 * kDegree);
  // The slope of the ground is not known.
  EXPECT_GT(std::sqrt(pitchVariance(result.imu.normal, result.imu.normal_covariance)),
            0.99 * std::hypot(0.5, 0.4) * kDegree);
}

TEST(ApproachAngleNormal, FusesAnInertialSensorWithStereoUnlessItContradicts) {
  ApproachScene scene(46);
  scene.ground.line_offset = 0;
  const Pose pose = straight(attitude(-8, 0, 0), 1.8, 1.4, 10)(0);
  StereoDepthResult stereo = scene.stereo(pose, 0);
  stereo.plane = exactPlane(pose, kHeightShare, 0.7 * kDegree);
  const auto run = [&](double error, bool use) {
    scene.parameters.use_imu = use;
    ApproachAngleStage stage(scene.model, scene.parameters);
    return stage.process(0, scene.ground.left(scene.rig, pose), scene.ground.right(scene.rig, pose), stereo,
                         inertial(pose, pose, error));
  };
  const double alone = pitchOf(run(0.5 * kDegree, false).n);
  const ApproachAngleResult fused = run(0.5 * kDegree, true);
  // 0.7 degrees against 0.5 and the ground's 0.5 are equals.
  EXPECT_NEAR(pitchOf(fused.n) - alone, 0.25 * kDegree, 0.1 * kDegree);
  EXPECT_FALSE(fused.imu.failure) << fused.imu.failure.message();
  const ApproachAngleResult wrong = run(8 * kDegree, true);
  EXPECT_EQ(pitchOf(wrong.n), alone);
  EXPECT_EQ(wrong.imu.failure.reason, Reason::kRejected);
  EXPECT_NE(wrong.imu.failure.message().find("deg off the ground ahead"), std::string::npos);
}

TEST(ApproachAngleNormal, FollowsAQuickTurnByTheInertialSensorsRotation) {
  // From one frame to the next 9 degrees of yaw and 5 of pitch, there and back: more than is searched.
  ApproachScene scene(47);
  const auto path = [](double t) {
    const bool there = std::lround(t / kPeriod) % 2 == 1;
    return straight(attitude(there ? -13 : -8, 0, there ? 9 : 0), 1.8, 1.4, 10)(t);
  };
  const auto run = [&](bool use) {
    scene.parameters.use_imu = use;
    ApproachAngleStage stage(scene.model, scene.parameters);
    int known = 0;
    for (int i = 0; i < 5; ++i) {
      const Pose then = path((i - 1) * kPeriod), now = path(i * kPeriod);
      const ApproachAngleResult result =
          stage.process(i * kPeriod, scene.ground.left(scene.rig, now), scene.ground.right(scene.rig, now),
                        scene.stereo(now, i * kPeriod), inertial(then, now));
      if (result.step.failure) continue;
      ++known;
      expectMotion(result.step, Movement(then, now), now.height(), "frame " + std::to_string(i));
    }
    return known;
  };
  EXPECT_EQ(run(true), 4);
  EXPECT_LT(run(false), 4);
}

TEST(ApproachAngleNormal, LeavesOutARotationThatTheImagesContradict) {
  ApproachScene scene(48);
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage(scene.model, scene.parameters);
  for (int i = 0; i < 4; ++i) {
    const Pose then = path((i - 1) * kPeriod), now = path(i * kPeriod);
    AttitudePrior prior = inertial(then, now);
    prior.rotation.y() += 1.0 * kDegree;
    const ApproachAngleResult result =
        stage.process(i * kPeriod, scene.ground.left(scene.rig, now), scene.ground.right(scene.rig, now),
                      scene.stereo(now, i * kPeriod), prior);
    if (i > 0) expectMotion(result.step, Movement(then, now), now.height(), "frame " + std::to_string(i));
  }
}

}  // namespace
}  // namespace uav_landing
