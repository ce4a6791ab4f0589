#include "uav_landing/stages/approach_angle_stage.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/approach_scene.h"

namespace uav_landing {
namespace {

using namespace test;

TEST(ApproachAngleStage, ARepeatedPictureIsNoStandstillAndTheStepAfterItIsOverTheTimeOfBoth) {
  const ApproachScene scene(7);
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
  expectMotion(result.step, Movement(path(5 * kPeriod), now), now.height(), "after the repeated image");
}

TEST(ApproachAngleStage, APictureOnceMoreDoesNotConfirmTheRunwayInIt) {
  ApproachScene scene(7);
  scene.ground.contrast = 3;
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage(scene.model, scene.parameters);
  ApproachAngleResult result;
  double stamp = 0, taken = 0;
  std::string known;
  for (const char fresh : std::string("0rr0r0r0")) {
    stamp += kPeriod;
    if (fresh == '0') taken = stamp;
    const Pose pose = path(taken);
    StereoDepthResult stereo = scene.stereo(pose, stamp);
    stereo.left_repeated = fresh == 'r';
    result =
        stage.process(stamp, scene.ground.left(scene.rig, pose), scene.ground.right(scene.rig, pose), stereo);
    known += result.runway.failure ? '-' : '+';
  }
  EXPECT_EQ(known, "-----+-+");
}

/// What the stereo stage says of a pair while the plane is searched for.
enum class Plane { kSearching, kFound, kFollowed, kNone };

/// Pairs of a flight one after the other.
struct Searching {
  ApproachScene scene{7};
  std::function<Pose(double)> path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage;
  bool corners = true;  // that the stereo stage has matched

  explicit Searching(bool at_once = true, NormalSource source = NormalSource::kFused)
      : stage(scene.model, searching(at_once, source)) {}
  static ApproachAngleParameters searching(bool at_once, NormalSource source) {
    ApproachAngleParameters parameters;
    parameters.search_at_once = at_once;
    parameters.normal_source = source;
    return parameters;
  }

  ApproachAngleResult next(int i, Plane plane, bool repeated = false) {
    const double stamp = i * kPeriod;
    const Pose pose = path(repeated ? stamp - kPeriod : stamp);
    StereoDepthResult stereo = scene.stereo(pose, stamp);
    if (!corners) stereo.points.clear();
    stereo.from_search = plane != Plane::kFollowed;
    stereo.left_repeated = repeated;
    if (plane == Plane::kSearching || plane == Plane::kNone) {
      StereoDepthResult none;
      none.stamp = stamp;
      none.from_search = true;
      none.left_repeated = repeated;
      none.failure = {plane == Plane::kNone ? Reason::kNoPlane : Reason::kNotYet, "no plane"};
      stereo = none;
    }
    return stage.process(stamp, scene.ground.left(scene.rig, pose), scene.ground.right(scene.rig, pose),
                         stereo);
  }
};

TEST(ApproachAngleStage, SearchesForTheMotionFromThePairAfterThePlaneOn) {
  Searching flight;
  EXPECT_TRUE(flight.next(0, Plane::kSearching).step.failure);
  EXPECT_TRUE(flight.next(1, Plane::kSearching).step.failure);
  EXPECT_EQ(flight.next(2, Plane::kFound).step.failure.reason, Reason::kNotYet);
  const ApproachAngleResult result = flight.next(3, Plane::kFollowed);
  const Pose now = flight.path(3 * kPeriod);
  expectMotion(result.step, Movement(flight.path(2 * kPeriod), now), now.height(), "after the search");
}

TEST(ApproachAngleStage, APictureOnceMoreDuringTheSearchIsNoStepInTime) {
  Searching flight;
  flight.next(0, Plane::kSearching);
  flight.next(1, Plane::kSearching, true);
  const ApproachAngleResult result = flight.next(2, Plane::kFollowed);
  const Pose now = flight.path(2 * kPeriod);
  EXPECT_NEAR(result.step.duration, 2 * kPeriod, 1e-9);
  expectMotion(result.step, Movement(flight.path(0), now), now.height(), "over the time of both");
}

TEST(ApproachAngleStage, LeavesOutTheLinesWhileItSearchesForTheFirstStep) {
  Searching flight(false);
  flight.next(0, Plane::kFound);
  const ApproachAngleResult first = flight.next(1, Plane::kFollowed);
  const Pose now = flight.path(kPeriod);
  expectMotion(first.step, Movement(flight.path(0), now), now.height(), "first step");
  EXPECT_EQ(first.left.failure.reason, Reason::kNotYet);
  EXPECT_EQ(first.right.failure.reason, Reason::kNotYet);
  EXPECT_TRUE(first.left.lines.empty());
  const ApproachAngleResult second = flight.next(2, Plane::kFollowed);
  EXPECT_FALSE(second.step.failure);
  EXPECT_FALSE(second.left.failure) << second.left.failure.message();
  EXPECT_FALSE(second.right.failure) << second.right.failure.message();
}

TEST(ApproachAngleStage, LooksForLinesInEveryPairWhereTheyAloneGiveTheNormal) {
  Searching flight(false, NormalSource::kVanishingLine);
  flight.next(0, Plane::kFound);
  ApproachAngleResult result;
  for (int i = 1; i < 5; ++i) {
    result = flight.next(i, Plane::kFollowed);
    EXPECT_FALSE(result.left.failure) << i << ' ' << result.left.failure.message();
  }
  EXPECT_FALSE(result.step.failure) << result.step.failure.message();
}

TEST(ApproachAngleStage, LooksForLinesInEverySecondPairWhereNoMotionIsFound) {
  Searching flight(false);
  flight.corners = false;
  flight.next(0, Plane::kFound);
  for (int i = 1; i < 7; ++i) {
    const ApproachAngleResult result = flight.next(i, Plane::kFollowed);
    EXPECT_TRUE(result.step.failure) << i;
    EXPECT_EQ(result.left.lines.empty(), i % 2 == 1) << i;
  }
}

TEST(ApproachAngleStage, DoesNotWaitForeverWhereEachPairIsSearched) {
  Searching flight;
  EXPECT_TRUE(flight.next(0, Plane::kFound).step.failure);
  EXPECT_FALSE(flight.next(1, Plane::kFound).step.failure);
}

TEST(ApproachAngleStage, DoesNotWaitForAPlaneThatIsNotThere) {
  Searching flight;
  flight.next(0, Plane::kNone);
  EXPECT_NE(flight.next(1, Plane::kNone).step.failure.reason, Reason::kNotYet);
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
    const ApproachScene scene(31);
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
  const ApproachScene scene(32);
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
    const ApproachScene scene(33);
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

TEST(ApproachAngleStage, GivesTheGeneralAngleAndEq1AsGeometrySays) {
  // With drift eq (1) is the difference of pitch and the focus' elevation in the image: worked out from the
  // poses.
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.8, 10, 20);
  constexpr int kFrames = 3;
  ApproachScene general(38), eq1(38);
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
    ApproachScene scene(38);
    scene.parameters.angle_formula = eq1 ? AngleFormula::kEq1 : AngleFormula::kGeneral;
    scene.parameters.foe_method = eq1 ? FoeMethod::kMotion : FoeMethod::kSlidingWindow;
    const ApproachAngleResult result = scene.run(path, 5).back();
    ASSERT_FALSE(result.failure) << result.failure.message();
    EXPECT_EQ(result.window.angle, result.step.angle);
    EXPECT_EQ(result.window.duration, result.step.duration);
  }
}

TEST(ApproachAngleStage, FindsTheFocusByTheSlidingWindow) {
  ApproachScene scene(39);
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
}

TEST(ApproachAngleStage, ClaimsWhatRotationLeftInTheVelocitiesMakesOfTheFocus) {
  ApproachScene scene(39);
  scene.parameters.foe_method = FoeMethod::kSlidingWindow;
  scene.parameters.angle_window = 0;
  scene.parameters.remove_rotation = false;
  const auto path = [](double t) {
    Pose pose = straight(attitude(-8, 0, 0), 1.8, 1.8, 10)(t);
    pose.pitch += 4 * t * kDegree;
    return pose;
  };
  const ApproachAngleResult result = scene.run(path, 3).back();
  ASSERT_FALSE(result.failure) << result.failure.message();
  const Pose now = path(2 * kPeriod), previous = path(kPeriod);
  const Eigen::Vector2d off = result.foe - scene.rig.project(now.seen(now.position - previous.position));
  ASSERT_GT(off.norm(), 10);
  EXPECT_LT(off.dot(result.foe_covariance.inverse() * off), 9);
  EXPECT_LT(std::abs(result.window.angle - 10 * kDegree), 2 * std::sqrt(result.window.angle_variance));
}

TEST(ApproachAngleStage, ClaimsWhatEq1LeavesOut) {
  ApproachScene scene(38);
  scene.parameters.angle_window = 0;
  scene.parameters.angle_formula = AngleFormula::kEq1;
  const ApproachAngleResult result = scene.run(straight(attitude(-8, -8, 0), 1.8, 1.8, 10, 20), 3).back();
  ASSERT_FALSE(result.failure) << result.failure.message();
  const double error = std::abs(result.window.angle - 10 * kDegree);
  ASSERT_GT(error, 1 * kDegree);
  EXPECT_LT(error, 2 * std::sqrt(result.window.angle_variance));
}

TEST(ApproachAngleStage, ForgetsThePastWhenTheStampDoesNotIncrease) {
  const ApproachScene scene(40);
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
  const ApproachScene scene(41);
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
  const ApproachScene scene(42);
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

TEST(ApproachAngleStage, TimesAreThoseOfThisPair) {
  const ApproachScene scene(41);
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage(scene.model, scene.parameters);
  const auto process = [&](double t, const cv::Mat& left) {
    stage.process(t, left, scene.ground.right(scene.rig, path(t)), scene.stereo(path(t), t));
  };
  process(0, scene.ground.left(scene.rig, path(0)));
  EXPECT_FALSE(stage.timings().parts().empty());
  process(0.1, cv::Mat());
  EXPECT_TRUE(stage.timings().parts().empty()) << "nothing was done with it";
}

TEST(ApproachAngleStage, ForgetsTheRunwayAtAReset) {
  ApproachScene scene(7);
  scene.ground.contrast = 3;
  const auto path = straight(attitude(-8, 0, 0), 1.8, 1.4, 10);
  ApproachAngleStage stage(scene.model, scene.parameters);
  const auto runwayAt = [&](int i) {
    const double t = i * kPeriod;
    return stage
        .process(t, scene.ground.left(scene.rig, path(t)), scene.ground.right(scene.rig, path(t)),
                 scene.stereo(path(t), t))
        .runway.failure.reason;
  };
  for (int i = 0; i < 4; ++i) EXPECT_EQ(runwayAt(i) == Reason::kNotYet, i < 2) << i;
  stage.reset();
  for (int i = 4; i < 7; ++i) EXPECT_EQ(runwayAt(i) == Reason::kNotYet, i < 6) << i;
}

}  // namespace
}  // namespace uav_landing
