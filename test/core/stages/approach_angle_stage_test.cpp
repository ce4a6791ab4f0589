#include "uav_landing/stages/approach_angle_stage.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Movement;
using test::Pose;

constexpr double kPeriod = 0.1;  // s
constexpr double kHeightShare = 1e-3, kNormalStddev = 5e-4;

/// One rig over one ground with two painted lines; what stereo says of it is the truth with a small
/// covariance.
struct Scene {
  StereoRig rig = test::makeRig(320, 240, 0.65);
  RigModel model = test::makeModel(rig);
  GroundRenderer ground;
  ApproachAngleParameters parameters;

  explicit Scene(unsigned seed) : ground(seed) {
    ground.line_offset = 1.0;
    ground.line_width = 0.12;
  }

  StereoDepthResult stereo(const Pose& pose, double stamp) const {
    StereoDepthResult result;
    result.stamp = stamp;
    result.plane = test::exactPlane(pose, kHeightShare, kNormalStddev);
    for (int v = rig.size.height * 45 / 100; v < rig.size.height - 10; v += 7)
      for (int u = 10; u < rig.size.width - 10; u += 9) {
        const double disparity = result.plane.disparity(rig, u, v);
        if (disparity > 1) result.points.push_back({double(u), double(v), disparity, 0.05, true});
      }
    return result;
  }

  std::vector<ApproachAngleResult> run(const std::function<Pose(double)>& path, int frames) const {
    ApproachAngleStage stage(model, parameters);
    std::vector<ApproachAngleResult> results;
    for (int i = 0; i < frames; ++i) {
      const Pose pose = path(i * kPeriod);
      results.push_back(stage.process(i * kPeriod, ground.left(rig, pose), ground.right(rig, pose),
                                      stereo(pose, i * kPeriod)));
    }
    return results;
  }
};

Pose attitude(double pitch_deg, double roll_deg, double yaw_deg) {
  Pose pose;
  pose.pitch = pitch_deg * kDegree;
  pose.roll = roll_deg * kDegree;
  pose.yaw = yaw_deg * kDegree;
  return pose;
}

/// Straight path from (x, 0, height): angle below the horizontal, drift to the left.
std::function<Pose(double)> straight(const Pose& start, double height, double speed, double angle_deg,
                                     double track_deg = 0) {
  return [=](double t) {
    Pose pose = start;
    const double angle = angle_deg * kDegree, track = track_deg * kDegree;
    pose.position = Eigen::Vector3d(0, 0, height) + speed * t *
                                                        Eigen::Vector3d(std::cos(angle) * std::cos(track),
                                                                        std::cos(angle) * std::sin(track),
                                                                        -std::sin(angle));
    return pose;
  };
}

/// A motion is the one that the poses say, within what it claims; of the length of t, a thousandth is granted
/// for errors that neighbouring matches have in common.
void expectMotion(const ApproachAngleResult::Motion& motion, const Movement& truth, double height,
                  const std::string& what) {
  ASSERT_FALSE(motion.failure) << what << ": " << motion.failure.message();
  const double stddev = std::sqrt(motion.angle_variance);
  EXPECT_NEAR(motion.angle, truth.angle, 3.5 * stddev) << what;
  EXPECT_LT(stddev, 0.6 * kDegree) << what;
  const Eigen::Vector3d t = truth.t / height;
  const Eigen::AngleAxisd turn(truth.R);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(motion.translation_over_height[i], t[i],
                4 * std::hypot(std::sqrt(motion.covariance(3 + i, 3 + i)), 1e-3 * t.norm()))
        << what;
    EXPECT_NEAR(motion.rotation[i], turn.angle() * turn.axis()[i], 4 * std::sqrt(motion.covariance(i, i)))
        << what;
  }
}

TEST(ApproachAngleStage, ARepeatedPictureIsNoStandstillAndTheStepAfterItIsOverTheTimeOfBoth) {
  const Scene scene(7);
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage(scene.model, scene.parameters);
  ApproachAngleResult result;
  for (int i = 0; i < 8; ++i) {
    const bool repeated = i == 6;
    const double stamp = i * kPeriod, taken = repeated ? stamp - kPeriod : stamp;
    const Pose pose = path(taken);
    StereoDepthResult stereo = scene.stereo(pose, stamp);
    stereo.left_repeated = repeated;
    result =
        stage.process(stamp, scene.ground.left(scene.rig, pose), scene.ground.right(scene.rig, pose), stereo);
    if (!repeated) continue;
    EXPECT_EQ(result.step.failure.reason, Reason::kNoMotion);
    EXPECT_FALSE(result.failure) << result.failure.message();
    EXPECT_NEAR(result.window.angle, 10 * kDegree, 0.5 * kDegree);
  }
  EXPECT_NEAR(result.step.duration, 2 * kPeriod, 1e-9);
  const Pose now = path(7 * kPeriod);
  expectMotion(result.step, Movement(path(5 * kPeriod), now), now.height(), "after the repeated picture");
}

TEST(ApproachAngleStage, MeasuresDescendingLevelDriftingAndRollingMotion) {
  struct Case {
    std::string name;
    std::function<Pose(double)> path;
  };
  const auto rolling = [](double t) {
    Pose pose = straight(attitude(-8, 0, 0), 1.8, 1.4, 10)(t);
    pose.roll = (-4 + 15 * t) * kDegree;
    pose.pitch += 3 * t * kDegree;
    return pose;
  };
  const std::vector<Case> cases = {
      {"descending", straight(attitude(-8, 0, 0), 1.8, 1.4, 12)},
      {"level", straight(attitude(-6, 0, 0), 1.5, 1.4, 0)},
      {"climbing", straight(attitude(-6, 0, 0), 1.3, 1.4, -5)},
      {"crab", straight(attitude(-7, 2, -6), 1.8, 1.4, 8, 5)},
      {"rolling", rolling},
  };
  for (const Case& motion : cases) {
    const Scene scene(31);
    constexpr int kFrames = 7;
    const std::vector<ApproachAngleResult> results = scene.run(motion.path, kFrames);
    const Pose now = motion.path((kFrames - 1) * kPeriod), previous = motion.path((kFrames - 2) * kPeriod);
    const ApproachAngleResult& last = results.back();
    EXPECT_FALSE(last.failure) << motion.name << last.failure.message();
    expectMotion(last.step, Movement(previous, now), now.height(), motion.name + ", step");
    EXPECT_NEAR(last.step.duration, kPeriod, 1e-9);
    ASSERT_GT(last.window.duration, 2.5 * kPeriod) << motion.name;
    EXPECT_LE(last.window.duration, scene.parameters.angle_window + 1e-3);
    const Pose then = motion.path((kFrames - 1) * kPeriod - last.window.duration);
    expectMotion(last.window, Movement(then, now), now.height(), motion.name + ", window");
    // More motion, less noise.
    EXPECT_LT(last.window.angle_variance, 0.5 * last.step.angle_variance) << motion.name;
    // The focus of expansion of the step.
    const Eigen::Vector2d foe = scene.rig.project(now.seen(now.position - previous.position));
    for (int i = 0; i < 2; ++i)
      EXPECT_NEAR(last.foe[i], foe[i], 4 * std::sqrt(last.foe_covariance(i, i))) << motion.name;
  }
}

TEST(ApproachAngleStage, SaysNotYetOnTheFirstFrame) {
  const Scene scene(32);
  const ApproachAngleResult first = scene.run(straight(attitude(-8, 0, 0), 1.8, 1.4, 12), 1).front();
  EXPECT_EQ(first.failure.reason, Reason::kNotYet);
  EXPECT_EQ(first.step.failure.reason, Reason::kNotYet);
  EXPECT_EQ(first.window.failure.reason, Reason::kNotYet);
  EXPECT_TRUE(std::isnan(first.step.angle) && std::isnan(first.window.angle) && std::isnan(first.foe.x()));
  EXPECT_TRUE(first.n.allFinite()) << "the ground is known all the same";
}

TEST(ApproachAngleStage, ClaimsNoAngleWhenStandingStillOrOnlyTurning) {
  const auto still = straight(attitude(-8, 0, 0), 1.8, 0, 0);
  const auto turning = [](double t) {
    Pose pose = attitude(-8 + 5 * t, -3 + 8 * t, 6 * t);
    pose.position.z() = 1.8;
    return pose;
  };
  for (const std::function<Pose(double)>& path : {std::function<Pose(double)>(still), {turning}}) {
    const Scene scene(33);
    const std::vector<ApproachAngleResult> results = scene.run(path, 6);
    for (size_t i = 1; i < results.size(); ++i) {
      EXPECT_EQ(results[i].failure.reason, Reason::kNoMotion) << i << " " << results[i].failure.message();
      EXPECT_EQ(results[i].step.failure.reason, Reason::kNoMotion) << i;
      EXPECT_TRUE(std::isnan(results[i].step.angle)) << i;
      EXPECT_TRUE(std::isnan(results[i].foe.x())) << i;
      // The motion itself is known: none, and the rotation.
      EXPECT_LT(results[i].step.translation_over_height.norm(), 0.02) << i;
      const Movement truth(path(static_cast<double>(i - 1) * kPeriod),
                           path(static_cast<double>(i) * kPeriod));
      const Eigen::AngleAxisd turn(truth.R);
      EXPECT_LT((results[i].step.rotation - turn.angle() * turn.axis()).norm(), 2e-3) << i;
    }
  }
}

TEST(ApproachAngleStage, WorksWithoutStereoFromPaintedLines) {
  Scene scene(34);
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

TEST(ApproachAngleStage, SaysThatThereIsNoGroundNormalWithoutStereoAndLines) {
  Scene scene(35);
  scene.parameters.use_stereo = false;
  scene.ground.line_offset = 0;
  scene.ground.contrast = 1.5;  // strong texture has streaks along the runway
  const std::vector<ApproachAngleResult> results = scene.run(straight(attitude(-8, 0, 0), 1.8, 1.4, 10), 3);
  EXPECT_EQ(results.back().failure.reason, Reason::kNoGroundNormal) << results.back().failure.message();
  EXPECT_TRUE(results.back().left.failure && results.back().right.failure);
}

TEST(ApproachAngleStage, GivesTheDirectionOfTheRunwayInBothViews) {
  Scene scene(36);
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

TEST(ApproachAngleStage, CorrectsTheStereoNormalByTheVanishingPoint) {
  // Stereo that is wrong in pitch by one of its own sigma, of 0.3 degrees.
  Scene scene(37);
  scene.ground.contrast = 5;
  const Pose pose = straight(attitude(-8, 0, 0), 1.8, 1.4, 10)(0);
  Pose believed = pose;
  believed.pitch += 0.3 * kDegree;
  StereoDepthResult stereo = scene.stereo(pose, 0);
  stereo.plane = test::exactPlane(believed, kHeightShare, 0.3 * kDegree);
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

TEST(ApproachAngleStage, AnInertialSensorIsGroundNormalEnough) {
  // Neither stereo nor painted lines.
  Scene scene(45);
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

TEST(ApproachAngleStage, FusesAnInertialSensorWithStereoUnlessItContradicts) {
  Scene scene(46);
  scene.ground.line_offset = 0;
  const Pose pose = straight(attitude(-8, 0, 0), 1.8, 1.4, 10)(0);
  StereoDepthResult stereo = scene.stereo(pose, 0);
  stereo.plane = test::exactPlane(pose, kHeightShare, 0.7 * kDegree);
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

TEST(ApproachAngleStage, FollowsAQuickTurnByTheInertialSensorsRotation) {
  // From one frame to the next 9 degrees of yaw and 5 of pitch, there and back: more than is searched.
  Scene scene(47);
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

TEST(ApproachAngleStage, LeavesOutARotationThatTheImagesContradict) {
  Scene scene(48);
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

TEST(ApproachAngleStage, GivesTheGeneralAngleAndEq1AsGeometrySays) {
  // With drift eq (1) is the difference of pitch and the focus' elevation in the image: worked out from the
  // poses.
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.8, 10, 20);
  constexpr int kFrames = 3;
  Scene general(38), eq1(38);
  general.parameters.angle_window = eq1.parameters.angle_window = 0;
  eq1.parameters.angle_formula = AngleFormula::kEq1;
  const ApproachAngleResult a = general.run(path, kFrames).back(), b = eq1.run(path, kFrames).back();
  ASSERT_FALSE(a.failure) << a.failure.message();
  ASSERT_FALSE(b.failure) << b.failure.message();
  const Pose now = path(2 * kPeriod), previous = path(kPeriod);
  const Eigen::Vector3d t = now.seen(now.position - previous.position);
  const double expected_eq1 = 8 * kDegree + std::atan(t.y() / t.z());
  EXPECT_NEAR(a.window.angle, 10 * kDegree, 3.5 * std::sqrt(a.window.angle_variance));
  EXPECT_NEAR(b.window.angle, expected_eq1, 3.5 * std::sqrt(b.window.angle_variance));
  EXPECT_GT(expected_eq1 - 10 * kDegree, 0.4 * kDegree);
  EXPECT_GT(b.window.angle, a.window.angle);
}

TEST(ApproachAngleStage, PublishesThePapersFormsWhateverTheWindow) {
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.6, 10, 20);
  for (const bool eq1 : {true, false}) {
    Scene scene(38);
    scene.parameters.angle_formula = eq1 ? AngleFormula::kEq1 : AngleFormula::kGeneral;
    scene.parameters.foe_method = eq1 ? FoeMethod::kMotion : FoeMethod::kSlidingWindow;
    const ApproachAngleResult result = scene.run(path, 5).back();
    ASSERT_FALSE(result.failure) << result.failure.message();
    EXPECT_EQ(result.window.angle, result.step.angle);
    EXPECT_EQ(result.window.duration, result.step.duration);
  }
}

TEST(ApproachAngleStage, FindsTheFocusByTheSlidingWindow) {
  Scene scene(39);
  scene.parameters.foe_method = FoeMethod::kSlidingWindow;
  scene.parameters.angle_window = 0;
  const auto path = [](double t) {
    Pose pose = straight(attitude(-8, 0, 0), 1.8, 1.8, 10)(t);
    pose.pitch += 4 * t * kDegree;
    return pose;
  };
  const ApproachAngleResult result = scene.run(path, 3).back();
  ASSERT_FALSE(result.failure) << result.failure.message();
  const Pose now = path(2 * kPeriod), previous = path(kPeriod);
  const Eigen::Vector2d foe = scene.rig.project(now.seen(now.position - previous.position));
  EXPECT_LT((result.foe - foe).norm(), 6);
  EXPECT_NEAR(result.window.angle, 10 * kDegree, 1.5 * kDegree);
  EXPECT_EQ(result.window.angle, result.step.angle);
  scene.parameters.remove_rotation = false;
  const ApproachAngleResult raw = scene.run(path, 3).back();
  EXPECT_TRUE(raw.failure || (raw.foe - foe).norm() > (result.foe - foe).norm() + 5);
}

TEST(ApproachAngleStage, ForgetsThePastWhenTheStampDoesNotIncrease) {
  const Scene scene(40);
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  for (const double back : {0.0, -20.0}) {
    ApproachAngleStage stage(scene.model, scene.parameters);
    const auto process = [&](double stamp, double t) {
      const Pose pose = path(t);
      return stage.process(stamp, scene.ground.left(scene.rig, pose), scene.ground.right(scene.rig, pose),
                           scene.stereo(pose, stamp));
    };
    process(10, 0);
    EXPECT_FALSE(process(10.1, 0.1).failure);
    EXPECT_EQ(process(10.1 + back, 0).failure.reason, Reason::kNotYet) << back;
    EXPECT_FALSE(process(10.2 + back, 0.1).failure) << back;
    stage.reset();
    EXPECT_EQ(process(10.3 + back, 0.2).failure.reason, Reason::kNotYet) << back;
  }
}

TEST(ApproachAngleStage, GoesOnAfterBadPairs) {
  const Scene scene(41);
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage(scene.model, scene.parameters);
  const auto process = [&](double t, const cv::Mat& left, const StereoDepthResult& stereo) {
    return stage.process(t, left, scene.ground.right(scene.rig, path(t)), stereo);
  };
  const auto good = [&](double t) {
    return process(t, scene.ground.left(scene.rig, path(t)), scene.stereo(path(t), t));
  };
  good(0);
  EXPECT_FALSE(good(0.1).failure);
  const cv::Mat black(scene.rig.size, CV_8UC1, cv::Scalar(0));
  const ApproachAngleResult uniform = process(0.2, black, scene.stereo(path(0.2), 0.2));
  EXPECT_EQ(uniform.failure.reason, Reason::kUniformImage);
  EXPECT_EQ(uniform.step.failure.reason, Reason::kUniformImage);
  EXPECT_TRUE(std::isnan(uniform.window.angle));
  EXPECT_EQ(process(0.3, cv::Mat(), scene.stereo(path(0.3), 0.3)).failure.reason, Reason::kInputInvalid);
  EXPECT_TRUE(good(0.4).failure) << "only a black image to compare with";
  const ApproachAngleResult back = good(0.5);
  ASSERT_FALSE(back.failure) << back.failure.message();
  EXPECT_NEAR(back.step.angle, 10 * kDegree, 3.5 * std::sqrt(back.step.angle_variance));
}

TEST(ApproachAngleStage, MeasuresStepsOverALostPair) {
  const Scene scene(42);
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage(scene.model, scene.parameters);
  ApproachAngleResult result;
  for (const double t : {0.0, 0.1, 0.2, 0.4}) {
    const Pose pose = path(t);
    result = stage.process(t, scene.ground.left(scene.rig, pose), scene.ground.right(scene.rig, pose),
                           scene.stereo(pose, t));
  }
  ASSERT_FALSE(result.failure) << result.failure.message();
  EXPECT_NEAR(result.step.duration, 0.2, 1e-9);
  expectMotion(result.step, Movement(path(0.2), path(0.4)), path(0.4).height(), "gap");
}

}  // namespace
}  // namespace uav_landing
