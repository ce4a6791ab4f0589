#include "uav_landing/stages/kalman_height_stage.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <string>

#include "landing/height/height_track.h"
#include "support/degree.h"
#include "support/kalman_height_inputs.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

using test::angleAt;
using test::kDegree;
using test::kStep;
using test::noStereo;
using test::settle;
using test::stereoAt;
using test::usualRig;

TEST(KalmanHeightStage, SearchesUntilThereIsAPlane) {
  KalmanHeightStage stage(usualRig(), {});
  const LandingResult result = stage.process(noStereo(0), angleAt(0));
  EXPECT_EQ(result.status, Status::kSearching);
  EXPECT_EQ(result.failure.message(), "too_few_matches: 7 of at least 20");
  EXPECT_FALSE(result.height_valid);
  EXPECT_TRUE(std::isnan(result.height));
  EXPECT_TRUE(std::isnan(result.raw_height));
}

TEST(KalmanHeightStage, BelievesAHeightOnlyAfterItWasConfirmed) {
  KalmanHeightStage stage(usualRig(), {});
  for (int i = 0; i < HeightTrack::kConfirmations; ++i) {
    const LandingResult result = stage.process(stereoAt(i * kStep, 10), angleAt(i * kStep));
    EXPECT_EQ(result.status, Status::kTracking);
    EXPECT_NEAR(result.height, 10, 1e-6);
    const bool last = i + 1 == HeightTrack::kConfirmations;
    EXPECT_EQ(result.height_valid, last) << i;
    EXPECT_EQ(result.valid(), last);
    EXPECT_EQ(result.failure.reason, last ? Reason::kNone : Reason::kNotYet);
  }
}

TEST(KalmanHeightStage, IsLostAfterTheResetTimeoutAndFindsBack) {
  KalmanHeightStage stage(usualRig(), {});
  double stamp = settle(stage, 10);
  LandingResult result;
  for (int i = 0; i < 12; ++i, stamp += kStep) result = stage.process(noStereo(stamp), angleAt(stamp));
  EXPECT_EQ(result.status, Status::kLost);
  EXPECT_EQ(result.resets, 1);
  EXPECT_TRUE(std::isnan(result.height));
  result = stage.process(stereoAt(stamp, 4), angleAt(stamp));
  EXPECT_EQ(result.status, Status::kTracking);
  EXPECT_NEAR(result.height, 4, 1e-9);
  EXPECT_FALSE(result.height_valid);
}

TEST(KalmanHeightStage, AWrongFirstPlaneIsReplacedAtOnceAndThatBelievedAfterASecondWithoutAnother) {
  KalmanHeightStage stage(usualRig(), {});
  EXPECT_FALSE(stage.process(stereoAt(0, 17), angleAt(0)).height_valid);
  for (int i = 1; i < 20; ++i) {
    const LandingResult result = stage.process(stereoAt(i * kStep, 10), angleAt(i * kStep));
    EXPECT_NEAR(result.height, 10, 1e-6);
    EXPECT_EQ(result.height_valid, i >= 11) << i;  // 1 s after the pair that contradicted
  }
}

TEST(KalmanHeightStage, StartsAnewWhenTheStampGoesBackRepeatsOrJumpsAhead) {
  for (const double jump : {-5.0, 0.0, 30.0}) {
    KalmanHeightStage stage(usualRig(), {});
    const double last = settle(stage, 10);
    ASSERT_TRUE(stage.process(stereoAt(last, 10), angleAt(last)).angle_valid);
    const LandingResult result = stage.process(stereoAt(last + jump, 3), angleAt(last + jump));
    EXPECT_EQ(result.failure.reason, Reason::kTimeJump) << jump;
    EXPECT_FALSE(result.height_valid);
    EXPECT_FALSE(result.angle_valid) << "of before the jump, or of half of it ago";
    EXPECT_EQ(result.resets, 1);
    EXPECT_NEAR(result.height, 3, 1e-9);
  }
}

TEST(KalmanHeightStage, AStampThatIsNotANumberIsNeverValid) {
  KalmanHeightStage stage(usualRig(), {});
  const double stamp = settle(stage, 10);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const LandingResult result = stage.process(stereoAt(nan, 10), angleAt(nan));
  EXPECT_EQ(result.failure.reason, Reason::kInputInvalid);
  EXPECT_FALSE(result.height_valid);
  EXPECT_TRUE(stage.process(stereoAt(stamp, 10), angleAt(stamp)).height_valid);
}

TEST(KalmanHeightStage, IsNotValidWhenTheHeightIsUncertain) {
  KalmanHeightParameters parameters;
  parameters.max_height_error = 0.05;
  KalmanHeightStage stage(usualRig(), parameters);
  LandingResult result;
  for (int i = 0; i < 3; ++i)
    result = stage.process(stereoAt(i * kStep, 10, -0.1, 0, 1.0), angleAt(i * kStep));
  EXPECT_EQ(result.failure.reason, Reason::kUncertain);
  EXPECT_FALSE(result.height_valid);
  EXPECT_TRUE(result.angle_valid);
  EXPECT_FALSE(result.valid());
}

TEST(KalmanHeightStage, PublishesTheWindowsAngleAndTheStepsAsRaw) {
  KalmanHeightStage stage(usualRig(), {});
  ApproachAngleResult approach = angleAt(0);
  approach.step.failure = {};
  LandingResult result = stage.process(stereoAt(0, 10), approach);
  EXPECT_NEAR(result.approach_angle, 5 * kDegree, 1e-12);
  EXPECT_NEAR(result.raw_approach_angle, 5.2 * kDegree, 1e-12);
  EXPECT_TRUE(result.angle_valid);

  approach = angleAt(kStep);
  approach.window.failure = {Reason::kNotYet, ""};
  approach.step.failure = {};
  result = stage.process(stereoAt(kStep, 10), approach);
  EXPECT_NEAR(result.approach_angle, 5.2 * kDegree, 1e-12);
  EXPECT_TRUE(result.angle_valid);
}

TEST(KalmanHeightStage, NamesWhyThereIsNoAngleWhileTheHeightIsGood) {
  KalmanHeightStage stage(usualRig(), {});
  const double stamp = settle(stage, 10);
  ApproachAngleResult approach = angleAt(stamp);
  approach.window.angle_variance = std::pow(2 * kDegree, 2);
  LandingResult result = stage.process(stereoAt(stamp, 10), approach);
  EXPECT_TRUE(result.height_valid);
  EXPECT_FALSE(result.angle_valid);
  EXPECT_EQ(result.failure.message(), "uncertain: approach angle has 1 sigma of 2 deg, more than 1 deg");

  ApproachAngleResult standing;
  standing.stamp = stamp + kStep;
  standing.failure = {Reason::kNoMotion, "standing still"};
  result = stage.process(stereoAt(stamp + kStep, 10), standing);
  EXPECT_TRUE(result.height_valid);
  EXPECT_FALSE(result.angle_valid);
  EXPECT_EQ(result.failure.message(), "no_motion: standing still");
}

/// A step of 2 m along t at a height of 10 m with the camera level, in 0.1 s: known to 1 mm.
ApproachAngleResult withStep(ApproachAngleResult approach, double descent) {
  approach.step.failure = {};
  approach.step.duration = kStep;
  approach.step.rotation.setZero();
  approach.step.translation_over_height = Eigen::Vector3d(0, descent, std::sqrt(4 - descent * descent)) / 10;
  approach.step.covariance = std::pow(0.001 / 10, 2) * Matrix6d::Identity();
  return approach;
}

TEST(KalmanHeightStage, ReportsTheVelocityInMetresPerSecond) {
  KalmanHeightStage stage(usualRig(), {});
  LandingResult result;
  for (int i = 0; i < 5; ++i) {
    result = stage.process(stereoAt(i * kStep, 10 - 0.2 * i, 0, 0), withStep(angleAt(i * kStep), 0.2));
    EXPECT_EQ(result.velocity.allFinite(), i > 2)
        << "three that agree tell whether another one is right, " << i;
  }
  // Steps are given as shares of the height.
  const double height = result.height;
  EXPECT_NEAR(result.velocity.y(), 0.02 * height / kStep, 1e-9);
  EXPECT_NEAR(result.speed(), 0.2 * height / kStep, 1e-9);
  // A ten-thousandth of the height in 0.1 s, and as much as the height.
  const double of_step = std::pow(1e-4 * height / kStep, 2);
  EXPECT_NEAR(result.speedVariance(), of_step + std::pow(0.2 / kStep, 2) * result.height_variance,
              0.01 * of_step);
  EXPECT_NEAR(result.twist_covariance(0, 0), of_step, 1e-9);
}

TEST(KalmanHeightStage, HasNoVelocityWhereTheHeightIsNotValid) {
  for (const double alert_limit : {0.5, 1e-3}) {
    KalmanHeightParameters parameters;
    parameters.alert_limit = alert_limit;
    parameters.alert_limit_relative = 0;
    KalmanHeightStage stage(usualRig(), parameters);
    LandingResult result;
    for (int i = 0; i < 5; ++i)
      result = stage.process(stereoAt(i * kStep, 10 - 0.2 * i, 0, 0), withStep(angleAt(i * kStep), 0.2));
    EXPECT_EQ(result.height_valid, alert_limit == 0.5);
    EXPECT_EQ(result.velocity.allFinite(), result.height_valid);
    EXPECT_EQ(result.twist_covariance.allFinite(), result.height_valid);
    EXPECT_TRUE(result.angular_velocity.allFinite()) << "it has no scale";
    EXPECT_TRUE((result.twist_covariance.bottomRightCorner<3, 3>().allFinite()));
  }
}

TEST(KalmanHeightStage, LearnsTheVerticalSpeedFromTheMotion) {
  // Descending by 0.2 m a step: two pairs whose heights are known to 5 cm only.
  const auto speed_after_two = [](bool use_motion) {
    KalmanHeightParameters parameters;
    parameters.use_motion = use_motion;
    KalmanHeightStage stage(usualRig(), parameters);
    stage.process(stereoAt(0, 10, 0, 0, 0.05), withStep(angleAt(0), 0.2));
    StereoDepthResult stereo = stereoAt(kStep, 9.8, 0, 0, 0.05);
    // The normal is known much better than the height, as stereo with a wide field of view has it.
    const double normal_variance = std::pow(1e-5, 2);
    stereo.plane.covariance(0, 0) = stereo.plane.covariance(2, 2) = normal_variance;
    return stage.process(stereo, withStep(angleAt(kStep), 0.2));
  };
  const LandingResult with = speed_after_two(true), without = speed_after_two(false);
  // 2 m/s down; the mean speed of the step is that of 0.05 s ago, worth 0.075 m/s at 1.5 m/s^2.
  EXPECT_NEAR(with.vertical_speed, -2.0, 0.1);
  EXPECT_LT(std::sqrt(with.vertical_speed_variance), 0.1);
  EXPECT_GT(std::sqrt(without.vertical_speed_variance), 0.4);
}

TEST(KalmanHeightStage, LearnsNoVerticalSpeedByAPlaneThatTheVanishingPointContradicts) {
  // Level flight at 20 m/s over a plane that seems tilted by 2 degrees: 0.7 m/s upwards by the motion.
  const auto speed_after = [](double seen_pitch) {
    KalmanHeightStage stage(usualRig(), {});
    LandingResult result;
    for (int i = 0; i < 10; ++i) {
      ApproachAngleResult approach = withStep(angleAt(i * kStep), 0.2);
      approach.step.translation_over_height = {0, 0, 0.2};
      approach.vanishing_direction = Eigen::Vector3d(0, std::sin(seen_pitch), std::cos(seen_pitch));
      approach.vanishing_covariance = std::pow(0.05 * kDegree, 2) * Eigen::Matrix3d::Identity();
      approach.other_runway_probability = 0;
      result = stage.process(stereoAt(i * kStep, 10, 2 * kDegree, 0, 0.05), approach);
    }
    return result.vertical_speed;
  };
  EXPECT_GT(std::abs(speed_after(2 * kDegree)), 0.5) << "what agrees is believed";
  EXPECT_LT(std::abs(speed_after(0)), 0.05);
}

TEST(KalmanHeightStage, TimeoutIsLostAndNothingIsValid) {
  KalmanHeightStage stage(usualRig(), {});
  const double stamp = settle(stage, 10);
  LandingResult result = stage.timeout(stamp + 0.3);
  EXPECT_EQ(result.yaw_failure.reason, Reason::kTimeout);
  EXPECT_EQ(result.status, Status::kLost);
  EXPECT_EQ(result.failure.reason, Reason::kTimeout);
  EXPECT_FALSE(result.height_valid || result.angle_valid);
  EXPECT_DOUBLE_EQ(result.stamp, stamp + 0.3);
  EXPECT_EQ(stage.timeout(stamp + 5).resets, 1);
}

StereoDepthResult bentRig(double stamp, double roll_deg) {
  StereoDepthResult stereo = stereoAt(stamp, 10);
  stereo.disparity_bias_stddev = 0.02;
  stereo.vertical_rotation.w = {0, 0, roll_deg * kDegree};
  stereo.vertical_rotation.covariance = std::pow(0.003 * kDegree, 2) * Eigen::Matrix3d::Identity();
  return stereo;
}

TEST(KalmanHeightStage, IsNotValidWhenTheRigIsCertainlyBentBeyondTheLimit) {
  for (const double roll_deg : {0.3, -0.3}) {
    KalmanHeightStage stage(usualRig(), {});
    LandingResult result;
    for (int i = 0; i < 50; ++i) result = stage.process(bentRig(i * kStep, roll_deg), angleAt(i * kStep));
    EXPECT_EQ(result.failure.reason, Reason::kRigBent);
    EXPECT_NE(result.failure.detail.find("roll"), std::string::npos) << result.failure.detail;
    EXPECT_NE(result.failure.detail.find("0.2 deg allowed"), std::string::npos) << result.failure.detail;
    EXPECT_FALSE(result.height_valid || result.angle_valid);
    EXPECT_NEAR(result.rig_rotation.w.z(), roll_deg * kDegree, 0.03 * kDegree);
  }
}

TEST(KalmanHeightStage, KnowsNoPlaceByAHeightThatABentRigMade) {
  for (const double roll_deg : {0.0, 0.3}) {
    KalmanHeightStage stage(usualRig(), {});
    LandingResult result;
    for (int i = 0; i < 50; ++i) {
      ApproachAngleResult approach = angleAt(i * kStep);
      approach.other_runway_probability = 0;
      approach.runway.x = -8;
      approach.runway.y = 0.1;
      approach.runway.width = 4;
      approach.runway.x_variance = approach.runway.y_variance = approach.runway.width_variance = 1e-6;
      result = stage.process(bentRig(i * kStep, roll_deg), approach);
    }
    EXPECT_EQ(std::isfinite(result.y), roll_deg == 0);
    EXPECT_EQ(std::isfinite(result.x), roll_deg == 0);
    EXPECT_EQ(std::isfinite(result.y_variance), roll_deg == 0);
  }
}

TEST(KalmanHeightStage, ReportsABentRigWithinTheLimitAndNoneWhenNotWatching) {
  KalmanHeightParameters parameters;
  KalmanHeightStage watching(usualRig(), parameters);
  parameters.rig_watch = false;
  KalmanHeightStage blind(usualRig(), parameters);
  LandingResult result, unwatched;
  for (int i = 0; i < 50; ++i) {
    result = watching.process(bentRig(i * kStep, 0.15), angleAt(i * kStep));
    unwatched = blind.process(bentRig(i * kStep, 0.4), angleAt(i * kStep));
  }
  EXPECT_TRUE(result.valid()) << result.failure.message();
  EXPECT_NEAR(result.rig_rotation.w.z(), 0.15 * kDegree, 0.03 * kDegree);
  EXPECT_TRUE(unwatched.valid());
  EXPECT_FALSE(unwatched.rig_rotation.known());
}

TEST(KalmanHeightStage, LearnsTheVerticalSpeedByTheHeightThatTheMotionIsOf) {
  // The surface bends down below: the camera is 11 m above it, but 10 m above the plane ahead, of which the
  // motion is. It descends by 2 m/s.
  KalmanHeightStage stage(usualRig(), {});
  LandingResult result;
  for (int i = 0; i < 2; ++i) {
    const double height = 10 - 0.2 * i;
    StereoDepthResult stereo = stereoAt(i * kStep, height, 0, 0, 0.05);
    stereo.plane.covariance(0, 0) = stereo.plane.covariance(2, 2) = std::pow(1e-5, 2);
    stereo.below = {Eigen::Vector3d(0, 1 / (height + 1), 0), stereo.plane.covariance};
    ApproachAngleResult approach = withStep(angleAt(i * kStep), 0.2);
    approach.step.translation_over_height *= 10 / height;
    result = stage.process(stereo, approach);
  }
  EXPECT_NEAR(result.raw_height, 10.8, 0.01);
  EXPECT_LT(std::sqrt(result.vertical_speed_variance), 0.12);
  EXPECT_NEAR(result.vertical_speed, -2.0, 0.12);
}

}  // namespace
}  // namespace uav_landing
