/// What the ground's normal by the images' motion does to the height, and what it is kept from.

#include <gtest/gtest.h>

#include <cmath>

#include "support/degree.h"
#include "support/ground_matches.h"
#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

using test::kDegree;

constexpr double kPitch = -4 * kDegree, kPitchStddev = 0.1 * kDegree, kStep = 0.05;

/// A plane that is known best where the ground is seen, 11 degrees below the axis, as planes are: pitch and
/// height are wrong together.
StereoDepthResult stereoAt(double stamp, double height, double pitch_error = 0) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  stereo.plane.g = normalFromPitchRoll(kPitch + pitch_error, 0) / height;
  const double below = 0.2;
  const Eigen::Vector3d seen = Eigen::Vector3d(0, below, 1).normalized();
  const double across = kPitchStddev / (seen.y() * height);
  stereo.plane.covariance =
      across * across * (Eigen::Matrix3d::Identity() - (1 - 1e-4) * seen * seen.transpose());
  stereo.points = test::matchesOn(test::usualRig(), stereo.plane.g);
  stereo.disparity_bias_stddev = 0.02;
  return stereo;
}

/// Level flight in which the images' motion asks for a normal that is off by this.
ApproachAngleResult motionAt(double stamp, double height, double off) {
  constexpr double kOwn = 0.02 * kDegree;
  ApproachAngleResult approach;
  approach.stamp = stamp;
  approach.n = normalFromPitchRoll(kPitch, 0);
  approach.n_covariance = kPitchStddev * kPitchStddev * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d normal = normalFromPitchRoll(kPitch + off, 0);
  for (ApproachAngleResult::Motion* motion : {&approach.step, &approach.window}) {
    motion->duration = kStep;
    motion->rotation.setZero();
    motion->translation_over_height = Eigen::Vector3d(0, -std::sin(-kPitch), std::cos(kPitch)) / height;
    motion->covariance = 1e-8 * Matrix6d::Identity();
    motion->angle = 0;
    motion->angle_variance = 1e-6;
    motion->normal = normal;
    motion->normal_covariance = kOwn * kOwn * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
  }
  return approach;
}

TEST(KalmanHeightMotionNormal, AHeightByAWrongOneIsWithinTheProtectionLevelThatNamesIt) {
  constexpr double kHeight = 20;
  KalmanHeightParameters parameters;
  parameters.alert_limit_relative = 0.2;
  parameters.unwatched_scale_error = 0;  // larger
  parameters.rig_watch = false;          // it would take the error for a yaw in time
  KalmanHeightStage stage(test::usualRig(), parameters);
  LandingResult result;
  for (double stamp = 1; stamp < 3; stamp += kStep)
    result = stage.process(stereoAt(stamp, kHeight), motionAt(stamp, kHeight, 0.15 * kDegree));
  EXPECT_TRUE(result.height_valid) << result.failure.message();
  EXPECT_EQ(failedTests(result.tests), "");
  const double error = std::abs(result.height - kHeight);
  EXPECT_GT(error, 0.15);
  EXPECT_GT(result.height_protection_level, error);
  EXPECT_EQ(result.protection_source, "motion");
}

TEST(KalmanHeightMotionNormal, OneThatContradictsIsNamedAndTakesTheSpeedByTheMotionAway) {
  double speed_variance[2];
  for (const bool contradicts : {false, true}) {
    KalmanHeightStage stage(test::usualRig(), {});
    LandingResult result;
    for (double stamp = 1; stamp < 1.5; stamp += kStep)
      result = stage.process(stereoAt(stamp, 10), motionAt(stamp, 10, contradicts ? 2 * kDegree : 0));
    EXPECT_EQ(failedTests(result.tests), contradicts ? "motion_normal" : "");
    speed_variance[contradicts] = result.vertical_speed_variance;
  }
  EXPECT_GT(speed_variance[1], 2 * speed_variance[0]);
}

// A frozen left picture against right ones that go on looks like a right camera that turns.
TEST(KalmanHeightMotionNormal, PairsThatAreRefusedTeachNothingOfTheRig) {
  for (const bool left : {false, true}) {
    KalmanHeightStage stage(test::usualRig(), {});
    LandingResult result;
    double stamp = 1;
    for (; stamp < 2; stamp += kStep) result = stage.process(stereoAt(stamp, 30), motionAt(stamp, 30, 0));
    const RigRotation before = result.rig_rotation;
    ASSERT_TRUE(before.known());
    for (int i = 0; i < 8; ++i, stamp += kStep) {
      StereoDepthResult stereo = stereoAt(stamp, 30, 0.25 * kDegree);
      (left ? stereo.left_repeated : stereo.right_repeated) = true;
      result = stage.process(stereo, motionAt(stamp, 30, 0));
    }
    EXPECT_NEAR(result.rig_rotation.w.y(), before.w.y(), 0.1 * std::sqrt(before.covariance(1, 1))) << left;
    EXPECT_GE(result.rig_rotation.covariance(1, 1), before.covariance(1, 1)) << left;
    for (int i = 0; i < 8; ++i, stamp += kStep)
      result = stage.process(stereoAt(stamp, 30, 0.25 * kDegree), motionAt(stamp, 30, 0));
    EXPECT_GT(std::abs(result.rig_rotation.w.y() - before.w.y()), 0.3 * std::sqrt(before.covariance(1, 1)))
        << "pairs that are not";
  }
}

}  // namespace
}  // namespace uav_landing
