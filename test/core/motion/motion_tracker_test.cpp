#include "motion/path/motion_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "image/windows/corners.h"
#include "support/counting_allocator.h"
#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Movement;
using test::Pose;

Pose makePose(double x, double z, double pitch_deg = -8, double yaw_deg = 0) {
  Pose pose;
  pose.position = {x, 0, z};
  pose.pitch = pitch_deg * kDegree;
  pose.yaw = yaw_deg * kDegree;
  return pose;
}

ApproachAngleParameters searchingAtOnce() {
  ApproachAngleParameters parameters;
  parameters.search_at_once = true;
  return parameters;
}

struct Scene {
  StereoRig rig = test::makeRig(320, 240, 0.65);
  GroundRenderer ground{51};
  ApproachAngleParameters parameters = searchingAtOnce();
  Timings timings;
  MotionTracker tracker{test::makeModel(rig), parameters};
  StepConditions conditions;

  cv::Mat image(const Pose& pose) const { return ground.left(rig, pose); }

  MotionTracker::Result process(double stamp, const Pose& pose) { return process(stamp, pose, image(pose)); }
  MotionTracker::Result process(double stamp, const Pose& pose, const cv::Mat& left) {
    cv::Mat below = cv::Mat::zeros(left.size(), CV_8UC1);
    below.rowRange(110, 230) = 255;
    std::vector<TrackedCorner> corners;
    for (const cv::Point& p : findCorners(left, below, {250, 1e-7, 4, 0.04})) {
      TrackedCorner corner;
      corner.u = p.x;
      corner.v = p.y;
      corners.push_back(corner);
    }
    const Eigen::Vector3d n = pose.down();
    const GroundNormal normal{n, 1e-7 * (Eigen::Matrix3d::Identity() - n * n.transpose())};
    return tracker.process(stamp, left, {normal, Eigen::Vector3d::Zero(), corners}, timings, conditions);
  }
};

void expectStep(const MotionTracker::Result& result, const Pose& then, const Pose& now) {
  ASSERT_FALSE(result.step.failure) << result.step.failure.message();
  const Movement truth(then, now);
  const Eigen::Vector3d t = truth.t / now.height();
  EXPECT_LT((result.step.translation_over_height - t).norm(), 0.01 * t.norm() + 0.002);
  const Eigen::AngleAxisd turn(truth.R);
  EXPECT_LT((result.step.rotation - turn.angle() * turn.axis()).norm(), 1e-3);
}

TEST(MotionTracker, FindsAFirstStepOfAnyLength) {
  for (const double share : {0.02, 0.1, 0.3, 0.7}) {
    Scene scene;
    const Pose then = makePose(-1.6 * share, 1.6 + 0.1 * share), now = makePose(0, 1.6, -7.5, 0.5);
    EXPECT_EQ(scene.process(1, then).step.failure.reason, Reason::kNotYet);
    expectStep(scene.process(1.1, now), then, now);
  }
}

TEST(MotionTracker, FollowsMotionThatChangesFromStepToStep) {
  Scene scene;
  const std::vector<Pose> poses = {makePose(-1, 1.8), makePose(-0.9, 1.8), makePose(-0.6, 1.75, -7),
                                   makePose(-0.55, 1.74, -6, 2), makePose(-0.1, 1.65, -8, 0)};
  scene.process(0, poses[0]);
  for (size_t i = 1; i < poses.size(); ++i)
    expectStep(scene.process(0.1 * static_cast<double>(i), poses[i]), poses[i - 1], poses[i]);
}

/// Flies on as before for a while, and then otherwise.
void expectJolt(Scene& scene, const Pose& jolt) {
  const auto at = [](double t) { return makePose(1.5 * t, 1.8 - 0.2 * t); };
  double t = 0;
  for (int i = 0; i < 6; ++i, t += 0.05) scene.process(t, at(t));
  Pose now = at(t);
  now.position += jolt.position;
  now.pitch += jolt.pitch;
  now.yaw += jolt.yaw;
  expectStep(scene.process(t, now), at(t - 0.05), now);
}

TEST(MotionTracker, FindsWhereAJoltLeadsAfterSteadyFlight) {
  for (const double turned : {0.05, 0.15, 0.3, 0.6, 1.2})
    for (const double sign : {-1, 1}) {
      SCOPED_TRACE(sign * turned);
      Scene pitched, yawed;
      expectJolt(pitched, makePose(0, 0, sign * turned));
      expectJolt(yawed, makePose(0, 0, 0, sign * turned));
    }
}

/// Along the path, up to so far to both sides, over texture of this contrast.
void paintLines(Scene& scene, double contrast, double reach) {
  scene.ground.contrast = contrast;
  scene.ground.line_offset = 0.5;
  scene.ground.bar_period = 0.6;
  scene.ground.bar_from = -10;
  scene.ground.bar_to = 30;
  scene.ground.bar_reach = reach;
}

TEST(MotionTracker, FindsThatTheSpeedChangedWhereMostOfWhatIsSeenAreLines) {
  for (const double farther : {-0.04, -0.02, -0.01, 0.01, 0.02, 0.04, 0.15, 0.3, 0.4, 0.5}) {
    SCOPED_TRACE(farther);
    Scene scene;
    paintLines(scene, 8, 1.5);
    expectJolt(scene, makePose(farther, 0, 0));
  }
}

TEST(MotionTracker, FindsAFirstStepWhereMostOfWhatIsSeenAreLines) {
  for (const double step : {0.1, 0.3, 0.5, 0.8, 1.2}) {
    SCOPED_TRACE(step);
    Scene scene;
    paintLines(scene, 4, 2.5);
    const Pose then = makePose(-step, 1.7), now = makePose(0, 1.7);
    scene.process(1, then);
    expectStep(scene.process(1.1, now), then, now);
  }
}

TEST(MotionTracker, KeepsUpWithASpeedThatGrowsWhereMostOfWhatIsSeenAreLines) {
  Scene scene;
  paintLines(scene, 4, 2.5);
  const auto at = [](double t) { return makePose(0.5 * t + 1.2 * t * t, 1.8 - 0.1 * t); };
  scene.process(0, at(0));
  for (int i = 1; i < 25; ++i) {
    SCOPED_TRACE(i);
    expectStep(scene.process(0.05 * i, at(0.05 * i)), at(0.05 * (i - 1)), at(0.05 * i));
  }
}

TEST(MotionTracker, ScalesItsPredictionWithTheTimeBetweenFrames) {
  Scene scene;
  const auto at = [](double t) { return makePose(1.5 * t, 1.8 - 0.2 * t, -8 + 3 * t); };
  for (const double t : {0.0, 0.1, 0.2}) scene.process(t, at(t));
  expectStep(scene.process(0.5, at(0.5)), at(0.2), at(0.5));
  expectStep(scene.process(0.55, at(0.55)), at(0.5), at(0.55));
}

TEST(MotionTracker, MeasuresTheStepFromASkippedFrame) {
  Scene scene;
  const auto at = [](double t) { return makePose(1.5 * t, 1.8 - 0.2 * t); };
  scene.process(0, at(0));
  scene.process(0.1, at(0.1));
  scene.tracker.skip(0.2, scene.image(at(0.2)));
  const MotionTracker::Result result = scene.process(0.3, at(0.3));
  EXPECT_NEAR(result.step.duration, 0.1, 1e-9);
  expectStep(result, at(0.2), at(0.3));
  EXPECT_FALSE(result.window.failure);
}

TEST(MotionTracker, MeasuresTheStepFromWhereARepeatedImageFirstCame) {
  Scene scene;
  const auto at = [](double t) { return makePose(-1 + t, 1.8 - 0.1 * t); };
  for (const double t : {0.0, 0.1, 0.2}) scene.process(t, at(t));
  const MotionTracker::Result last = scene.process(0.3, at(0.3)), again = scene.tracker.repeat(0.4);
  EXPECT_EQ(again.step.failure.reason, Reason::kNoMotion);
  EXPECT_EQ(again.window.angle, last.window.angle) << "the path is the one seen last";
  // A degree a second is nothing unusual.
  EXPECT_GE(again.window.angle_variance, last.window.angle_variance + std::pow(0.1 * M_PI / 180, 2));
  EXPECT_EQ(scene.tracker.repeat(0.9).window.failure.reason, Reason::kNoMotion) << "too long ago";
  EXPECT_EQ(scene.tracker.repeat(0.2).window.failure.reason, Reason::kNoMotion) << "the clock was set back";
  const MotionTracker::Result next = scene.process(0.5, at(0.5));
  EXPECT_NEAR(next.step.duration, 0.2, 1e-9);
  expectStep(next, at(0.3), at(0.5));
}

/// Largest difference of two results' motions; NaN when one of them has none.
double difference(const ApproachAngleResult::Motion& a, const ApproachAngleResult::Motion& b) {
  return (a.translation_over_height - b.translation_over_height).norm() + (a.rotation - b.rotation).norm() +
         std::abs(a.angle - b.angle) + std::abs(a.angle_variance - b.angle_variance);
}

TEST(MotionTracker, IsAsNewAfterAResetOrAClockThatIsSetBack) {
  const auto at = [](double t) { return makePose(1.5 * t, 1.8 - 0.2 * t); };
  for (const bool reset : {true, false}) {
    Scene used, fresh;
    for (int i = 0; i < 6; ++i) used.process(10 + 0.05 * i, makePose(0.9 * i * i * 0.05, 2 - 0.02 * i));
    if (reset) used.tracker.reset();
    const MotionTracker::Result first = used.process(1, at(0));
    EXPECT_EQ(first.step.failure.reason, Reason::kNotYet);
    EXPECT_EQ(first.window.failure.reason, Reason::kNotYet);
    EXPECT_TRUE(used.tracker.repeat(1.05).window.failure) << "of the motion before";
    fresh.process(1, at(0));
    for (int i = 1; i < 4; ++i) {
      const MotionTracker::Result again = used.process(1 + 0.1 * i, at(0.1 * i)),
                                  expected = fresh.process(1 + 0.1 * i, at(0.1 * i));
      ASSERT_FALSE(expected.step.failure || expected.window.failure);
      EXPECT_EQ(difference(again.step, expected.step), 0) << i;
      EXPECT_EQ(difference(again.window, expected.window), 0) << i;
    }
    EXPECT_EQ(used.tracker.repeat(1.4).window.angle_variance,
              fresh.tracker.repeat(1.4).window.angle_variance);
  }
}

TEST(MotionTracker, ForgetsTheMotionBeforeAGapOfTheWindow) {
  Scene scene;
  const auto at = [](double t) { return makePose(0.2 * t, 1.8 - 0.02 * t); };
  for (int i = 0; i < 4; ++i) scene.process(0.1 * i, at(0.1 * i));
  const double later = 0.3 + scene.parameters.angle_window + 0.2;
  const MotionTracker::Result result = scene.process(later, at(later));
  ASSERT_FALSE(result.step.failure) << result.step.failure.message();
  EXPECT_NEAR(result.step.duration, later - 0.3, 1e-9);
  EXPECT_NEAR(result.window.duration, later - 0.3, 1e-9) << "the step alone";
  expectStep(result, at(0.3), at(later));
}

TEST(MotionTracker, VariancesOfAStepAreThoseOfSamplesOfItsMotion) {
  Scene scene;
  scene.process(0, makePose(0, 1.8));
  const MotionTracker::Result result = scene.process(0.1, makePose(0.15, 1.76));
  ASSERT_TRUE(result.step_estimate && result.step_angle);
  const MotionEstimate& estimate = *result.step_estimate;
  EXPECT_EQ(result.step.covariance, (estimate.covariance.topLeftCorner<6, 6>()));
  EXPECT_EQ(result.step.normal_covariance, estimate.own_normal_covariance);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  // The angle of the path to the ground, from what the images moved by to what that may be instead.
  const auto spread = [&](const Eigen::Matrix<double, 9, 9>& covariance) {
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    const Eigen::SelfAdjointEigenSolver<Matrix6> axes(covariance.bottomRightCorner<6, 6>());
    const Matrix6 root = axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
    const auto angleOf = [](const Eigen::Vector3d& t, const Eigen::Vector3d& n) {
      return std::asin(n.dot(t) / (n.norm() * t.norm()));
    };
    constexpr int kSamples = 20000;
    double squares = 0;
    for (int i = 0; i < kSamples; ++i) {
      Eigen::Matrix<double, 6, 1> draw;
      for (double& one : draw) one = normal(random);
      const Eigen::Matrix<double, 6, 1> off = root * draw;
      const double angle = angleOf(estimate.motion.t + off.head<3>(), estimate.normal + off.tail<3>());
      squares += std::pow(angle - angleOf(estimate.motion.t, estimate.normal), 2) / kSamples;
    }
    return squares;
  };
  const double all = spread(estimate.covariance), of_normal = spread(estimate.of_normal);
  const PathAngleFilter::Measurement& step = *result.step_angle;
  EXPECT_NEAR(result.step.angle_variance / all, 1, 0.05);
  EXPECT_NEAR(step.by_normal * step.by_normal / of_normal, 1, 0.05);
  EXPECT_NEAR((step.variance + step.by_normal * step.by_normal) / all, 1, 0.05);
}

TEST(MotionTracker, LooksBackNoLongerThanItsWindow) {
  Scene scene;
  scene.parameters.angle_window = 0.3;
  scene.tracker = MotionTracker(test::makeModel(scene.rig), scene.parameters);
  const auto at = [](double t) { return makePose(1.5 * t, 1.8 - 0.2 * t); };
  MotionTracker::Result result;
  for (int i = 0; i < 6; ++i) result = scene.process(0.1 * i, at(0.1 * i));
  ASSERT_FALSE(result.window.failure);
  EXPECT_NEAR(result.window.duration, 0.3, 1e-9);
  const Movement truth(at(0.2), at(0.5));
  const Eigen::Vector3d t = truth.t / at(0.5).height();
  EXPECT_LT((result.window.translation_over_height - t).norm(), 0.005 * t.norm());
  EXPECT_GT(result.window.translation_over_height.norm(), 2.8 * result.step.translation_over_height.norm());
}

TEST(MotionTracker, FailsOnAnotherSceneAndRecovers) {
  Scene scene;
  scene.process(0, makePose(0, 1.8));
  EXPECT_FALSE(scene.process(0.1, makePose(0.15, 1.78)).step.failure);
  const GroundRenderer elsewhere(99);
  const auto other = [&](double x) { return elsewhere.left(scene.rig, makePose(x, 1.8)); };
  const MotionTracker::Result cut = scene.process(0.2, makePose(0, 1.8), other(0));
  EXPECT_TRUE(cut.step.failure.reason == Reason::kTooFewMatches ||
              cut.step.failure.reason == Reason::kMotionInconsistent)
      << cut.step.failure.message();
  EXPECT_TRUE(cut.window.failure);
  EXPECT_TRUE(std::isnan(cut.step.angle) && std::isnan(cut.window.angle));
  expectStep(scene.process(0.3, makePose(0.15, 1.8), other(0.15)), makePose(0, 1.8), makePose(0.15, 1.8));
}

TEST(MotionTracker, SearchesForTheMotionOverAnotherSceneOverSomePairs) {
  Scene scene;
  scene.conditions.time = SearchTime::kShort;
  scene.tracker = MotionTracker(test::makeModel(scene.rig), ApproachAngleParameters());
  const GroundRenderer elsewhere(99);
  const auto at = [](int i) { return makePose(0.1 * i, 1.8); };
  for (int i = 0; i < 5; ++i) scene.process(0.05 * i, at(i));
  EXPECT_FALSE(scene.process(0.25, at(5)).step.failure);
  MotionTracker::Result last;
  for (int i = 6; i < 10; ++i) {
    last = scene.process(0.05 * i, at(i), elsewhere.left(scene.rig, at(i)));
    // The first pair sees that the step is none of those expected; three then try three speeds each.
    if (i < 9) {
      EXPECT_EQ(last.step.failure.reason, Reason::kNotYet) << i;
    }
  }
  expectStep(last, at(8), at(9));
}

TEST(MotionTracker, OverBareGroundTheCornersThemselvesShowThatTheyLieOnIt) {
  Scene scene;
  scene.conditions.proof = GroundProof::kMotion;
  for (int i = 0; i < 5; ++i) {
    const Pose then = makePose(0.1 * (i - 1), 1.62 - 0.01 * i), now = makePose(0.1 * i, 1.61 - 0.01 * i);
    const MotionTracker::Result result = scene.process(i, now);
    if (i > 0) expectStep(result, then, now);
  }
}

TEST(MotionTracker, BetweenHousesNoStepIsBelievedUnlessStereoTellsTheirDepths) {
  Scene scene;
  scene.conditions.proof = GroundProof::kMotion;
  for (const double side : {-1.0, 1.0}) {
    const double near = 0.4 * side, far = 8 * side;
    scene.ground.boxes.push_back({{-5, std::min(near, far), -0.1}, {60, std::max(near, far), 4}});
  }
  for (int i = 0; i < 6; ++i) {
    const MotionTracker::Result result = scene.process(i, makePose(0.1 * i, 1.6));
    if (i == 0) continue;
    for (const ApproachAngleResult::Motion* motion : {&result.step, &result.window}) {
      EXPECT_EQ(motion->failure.reason, Reason::kPlaneUnproven) << i << ' ' << motion->failure.message();
      EXPECT_FALSE(std::isfinite(motion->angle)) << i;
    }
  }
}

TEST(MotionTracker, HoldsNoMoreImagesTheLongerItRuns) {
  Scene scene;
  const std::vector<cv::Mat> images = {scene.image(makePose(0, 1.8)), scene.image(makePose(0.1, 1.8))};
  const test::CountingAllocator allocator;
  {
    Scene counted;
    int after_second = 0, after_warm_up = 0;
    for (int i = 0; i < 24; ++i) {
      counted.process(5 + 0.1 * i, makePose(0, 1.8), images[i % 2]);
      if (i == 1) after_second = allocator.held;
      if (i == 11) after_warm_up = allocator.held;
    }
    EXPECT_GT(after_warm_up, 0);
    EXPECT_GE(after_second, after_warm_up) << "a window's images have their memory";
    EXPECT_LE(allocator.held, after_warm_up);
    for (int i = 24; i < 36; ++i) counted.tracker.skip(5 + 0.1 * i, images[i % 2]);
    EXPECT_LE(allocator.held, after_warm_up + 1);
  }
}

}  // namespace
}  // namespace uav_landing
