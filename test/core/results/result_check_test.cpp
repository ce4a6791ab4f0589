#include "uav_landing/results/result_check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

using Motion = ApproachAngleResult::Motion;

/// 2 m in 0.1 s at a height of 10 m, in a turn.
Motion possibleMotion() {
  Motion motion;
  motion.duration = 0.1;
  motion.rotation = {0.01, -0.02, 0.03};
  motion.translation_over_height = {0, 0.02, 0.2};
  motion.covariance = 1e-6 * Matrix6d::Identity();
  motion.angle = 0.1;
  motion.angle_variance = 1e-4;
  return motion;
}

void expectMovementKept(const Motion& kept) {
  const Motion given = possibleMotion();
  EXPECT_EQ(kept.duration, given.duration);
  EXPECT_EQ(kept.rotation, given.rotation);
  EXPECT_EQ(kept.translation_over_height, given.translation_over_height);
  EXPECT_EQ(kept.covariance, given.covariance);
}

void expectNoAngle(const Motion& kept) {
  EXPECT_TRUE(std::isnan(kept.angle));
  EXPECT_TRUE(std::isnan(kept.angle_variance));
}

void expectKept(const Motion& kept) {
  expectMovementKept(kept);
  EXPECT_EQ(kept.angle, possibleMotion().angle);
  EXPECT_EQ(kept.angle_variance, possibleMotion().angle_variance);
}

void expectUnknown(const Motion& kept) {
  EXPECT_TRUE(std::isnan(kept.duration));
  EXPECT_TRUE(kept.rotation.array().isNaN().all());
  EXPECT_TRUE(kept.translation_over_height.array().isNaN().all());
  EXPECT_TRUE(kept.covariance.array().isNaN().all());
  expectNoAngle(kept);
}

/// Both motions with the same numbers.
ApproachAngleResult checkedWith(const Failure& of_step, const Failure& of_window) {
  ApproachAngleResult result;
  result.step = result.window = possibleMotion();
  result.step.failure = of_step;
  result.window.failure = of_window;
  return checked(result);
}

TEST(ResultCheck, AMotionThatDidNotFailKeepsItsNumbers) {
  const ApproachAngleResult kept = checkedWith({}, {});
  expectKept(kept.step);
  expectKept(kept.window);
}

TEST(ResultCheck, AMotionThatFailedLosesEachOfItsNumbersButNotItsReason) {
  for (const Reason reason : {Reason::kNotYet, Reason::kInputInvalid, Reason::kTooFewMatches,
                              Reason::kMotionInconsistent, Reason::kTimeJump}) {
    SCOPED_TRACE(toString(reason));
    const Failure failure{reason, "3 of 300"};
    const ApproachAngleResult without_step = checkedWith(failure, {});
    expectUnknown(without_step.step);
    EXPECT_EQ(without_step.step.failure.message(), failure.message());
    expectKept(without_step.window);
    const ApproachAngleResult without_window = checkedWith({}, failure);
    expectUnknown(without_window.window);
    EXPECT_EQ(without_window.window.failure.message(), failure.message());
    expectKept(without_window.step);
  }
}

// The turn of a camera that hovers is measured all the same.
TEST(ResultCheck, AMotionTooSmallForADirectionKeepsItsNumbersButNoAngle) {
  const Failure failure{Reason::kNoMotion, "standing still"};
  const ApproachAngleResult kept = checkedWith(failure, failure);
  for (const Motion& motion : {kept.step, kept.window}) {
    expectMovementKept(motion);
    expectNoAngle(motion);
  }
}

TEST(ResultCheck, ARotationOfTheRigFurtherThanAnyIsLeftOut) {
  StereoRig rig;
  rig.size = {640, 480};
  const auto isKept = [&](double x, double y, double z) {
    StereoDepthResult result;
    result.failure = {Reason::kNotYet, ""};
    result.vertical_rotation = {{x, y, z}, 1e-6 * Eigen::Matrix3d::Identity(), 100};
    return checked(rig, result).vertical_rotation.known();
  };
  EXPECT_TRUE(isKept(0.1, -0.9, -0.1));
  EXPECT_FALSE(isKept(0.3, 0, 0));
  EXPECT_FALSE(isKept(0, 1e300, 0));
  EXPECT_FALSE(isKept(0, 0, -0.3));
}

}  // namespace
}  // namespace uav_landing
