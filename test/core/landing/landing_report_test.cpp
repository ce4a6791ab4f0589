#include "landing/report/landing_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/degree.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::kStep;
using test::measuredHeight;
using test::usualRig;

const Failure kNoPlaneFailure{Reason::kNoPlane, "of the height"};
const Failure kInconsistentFailure{Reason::kInconsistent, "row_agreement"};

PairVerdict passingPair() { return PairVerdict(test::noTests()); }
PairVerdict leftOutPair() {
  PairVerdict pair = passingPair();
  pair.failure = kInconsistentFailure;
  pair.angle_refused = true;
  return pair;
}

TEST(LandingReport, TheFirstFailureIsTheOneReported) {
  LandingResult result;
  addFailure(result, {});
  EXPECT_FALSE(result.failure);
  addFailure(result, kNoPlaneFailure);
  addFailure(result, kInconsistentFailure);
  EXPECT_EQ(result.failure.message(), kNoPlaneFailure.message());
}

TEST(LandingReport, AHeightIsRefusedForAReasonAndForNoneItIsNot) {
  LandingResult result;
  result.height_valid = result.angle_valid = true;
  refuseHeight(result, {});
  EXPECT_TRUE(result.height_valid);
  refuseHeight(result, kInconsistentFailure);
  EXPECT_FALSE(result.height_valid);
  EXPECT_TRUE(result.angle_valid);
  EXPECT_EQ(result.failure.message(), kInconsistentFailure.message());
}

TEST(LandingReport, ReportsTheHeightsOfThePairAndOfTheTrack) {
  MeasuredHeight measured = measuredHeight(10.5, 0.2);
  measured.points_height = 10.4;
  measured.width_height = 10.6;
  measured.width_height_variance = 0.3;
  TrackVerdict post = test::trackingAt(test::filterAt(10));
  post.vertical_speed = -2;
  post.vertical_speed_variance = 0.01;
  post.innovation = 0.4;
  post.innovation_variance = 0.09;
  LandingResult result;
  reportHeight(measured, passingPair(), post, result);
  EXPECT_EQ(result.raw_height, 10.5);
  EXPECT_NEAR(result.raw_height_variance, 0.04, 1e-12);
  EXPECT_EQ(result.points_height, 10.4);
  EXPECT_EQ(result.width_height, 10.6);
  EXPECT_EQ(result.width_height_variance, 0.3);
  EXPECT_EQ(result.height, 10);
  EXPECT_EQ(result.height_variance, post.height_variance);
  EXPECT_EQ(result.vertical_speed, -2);
  EXPECT_EQ(result.vertical_speed_variance, 0.01);
  EXPECT_EQ(result.innovation, 0.4);
  EXPECT_EQ(result.innovation_variance, 0.09);
  EXPECT_EQ(result.status, Status::kTracking);
  EXPECT_TRUE(result.height_valid);
  EXPECT_FALSE(result.rejected || result.failure);
}

TEST(LandingReport, AHeightThatThePairDoesNotHaveIsNotReportedAsRaw) {
  MeasuredHeight measured = measuredHeight(-3);
  measured.failure = kNoPlaneFailure;
  LandingResult result;
  reportHeight(measured, passingPair(), test::trackingAt(test::filterAt(10)), result);
  EXPECT_TRUE(std::isnan(result.raw_height));
  EXPECT_FALSE(result.rejected) << "there is nothing to reject";
  EXPECT_EQ(result.failure.message(), kNoPlaneFailure.message());
}

TEST(LandingReport, APairThatATestOrTheGateRefusesIsRejected) {
  TrackVerdict post = test::trackingAt(test::filterAt(10));
  LandingResult left_out, gated;
  reportHeight(measuredHeight(14), leftOutPair(), post, left_out);
  EXPECT_TRUE(left_out.rejected);
  EXPECT_EQ(left_out.raw_height, 14) << "what is refused is reported";
  EXPECT_EQ(left_out.failure.message(), kInconsistentFailure.message());
  post.rejection = {Reason::kRejected, "by the gate"};
  post.failure = {Reason::kTimeout, "too long"};
  post.consecutive_rejections = 7;
  reportHeight(measuredHeight(14), passingPair(), post, gated);
  EXPECT_TRUE(gated.rejected);
  EXPECT_EQ(gated.consecutive_rejections, 7);
  EXPECT_EQ(gated.failure.message(), "rejected: by the gate") << "the rest follows from it";
}

/// A track at this height that nothing contradicts.
HeightTrack trackAt(double height) {
  HeightTrack track({}, 0);
  MeasuredHeight measured = measuredHeight(height);
  measured.without.fill({height, measured.variance, {}});
  track.update(1, measured, false, {});
  return track;
}

LandingResult resultAt(double height) {
  LandingResult result;
  result.height = height;
  result.height_variance = 0.01 * 0.01;
  result.height_valid = true;
  return result;
}

// 2 % of the height by assumption, and of a fault of 1e-3 with a risk of 1e-5: 2.576 sigma.
TEST(LandingReport, AHeightWithinItsAlertLimitIsValid) {
  LandingResult result = resultAt(10);
  reportProtection(trackAt(10), std::nullopt, {}, result);
  EXPECT_NEAR(result.height_protection_level, 0.02 * 10 + 2.576 * 0.01, 1e-4);
  EXPECT_EQ(result.protection_source, "scale");
  EXPECT_NEAR(result.height_alert_limit, 0.05 * 10, 1e-12);
  EXPECT_TRUE(result.height_valid);
}

TEST(LandingReport, NearTheGroundTheAlertLimitIsALength) {
  LandingResult result = resultAt(1);
  reportProtection(trackAt(1), std::nullopt, {}, result);
  EXPECT_NEAR(result.height_alert_limit, 0.15, 1e-12);
}

TEST(LandingReport, AHeightThatMayBeFurtherOffThanItsAlertLimitIsNotValid) {
  for (const double lower : {0.4, 0.6}) {
    LandingResult result = resultAt(10);
    reportProtection(trackAt(10), GroundMemory::Below{10 + lower, 0.01 * 0.01}, {}, result);
    EXPECT_NEAR(result.height_protection_level, lower + 2.576 * 0.01, 1e-4);
    EXPECT_EQ(result.protection_source, "surface_below");
    EXPECT_EQ(result.height_valid, lower < 0.47);
  }
  LandingResult result = resultAt(10);
  reportProtection(trackAt(10), GroundMemory::Below{10.6, 0}, {}, result);
  EXPECT_EQ(result.failure.message(),
            "uncertain: height 10 m has a protection level of 0.6 m because of surface_below, alert limit "
            "0.5 m");
}

TEST(LandingReport, OfTwoBoundsTheLargerOneIsTheProtectionLevel) {
  LandingResult result = resultAt(10);
  reportProtection(trackAt(10), GroundMemory::Below{10.1, 0.01 * 0.01}, {}, result);
  EXPECT_EQ(result.protection_source, "scale");
}

/// A step of 20 m/s straight ahead over level ground 10 m below a level camera, whose normal all agree about.
struct Pair {
  StereoDepthResult stereo = test::stereoAt(1, 10, 0, 0, 0.002);
  ApproachAngleResult approach = test::withoutTurning(1);
  Ground ground = test::groundOf(stereo.plane);

  Pair() {
    approach.n = stereo.plane.normal();
    approach.n_covariance = stereo.plane.normalCovariance();
    approach.step.angle = 5.2 * kDegree;
    approach.step.angle_variance = std::pow(0.3 * kDegree, 2);
  }
  PairInput input() const { return test::pairOf(stereo, approach); }
};

TEST(LandingReport, TheAngleIsTheWindowsAndTheRawOneTheSteps) {
  Pair pair;
  pair.approach.foe = {300, 200};
  VelocityWatch::Verdict velocity;
  LandingResult result;
  reportAngle(pair.input(), pair.ground, PathDoubt({}), velocity, result);
  EXPECT_NEAR(result.approach_angle, 5 * kDegree, 1e-12);
  EXPECT_NEAR(std::sqrt(result.approach_angle_variance), 0.1 * kDegree, 1e-9);
  EXPECT_NEAR(result.raw_approach_angle, 5.2 * kDegree, 1e-12);
  EXPECT_NEAR(std::sqrt(result.raw_approach_angle_variance), 0.3 * kDegree, 1e-9);
  EXPECT_EQ(result.foe, Eigen::Vector2d(300, 200));

  velocity.path_doubt = 0.4 * kDegree;
  velocity.step_doubt = 0.5 * kDegree;
  reportAngle(pair.input(), pair.ground, PathDoubt({}), velocity, result);
  EXPECT_NEAR(std::sqrt(result.approach_angle_variance), std::hypot(0.1, 0.4) * kDegree, 1e-9);
  EXPECT_NEAR(std::sqrt(result.raw_approach_angle_variance), std::hypot(0.3, 0.5) * kDegree, 1e-9);

  pair.approach.window.failure = {Reason::kNotYet, ""};
  reportAngle(pair.input(), pair.ground, PathDoubt({}), {}, result);
  EXPECT_NEAR(result.approach_angle, 5.2 * kDegree, 1e-12) << "without a window";
}

// 5 degrees down the angle turns by 1 / cos(5 degrees) of the tilt.
TEST(LandingReport, TheAngleIsAsUncertainAsItsNormalIsDoubted) {
  Pair pair;
  pair.ground.tilted = true;
  pair.ground.normal = {normalFromPitchRoll(1 * kDegree, 0), pair.ground.normal->covariance()};
  LandingResult result;
  reportAngle(pair.input(), pair.ground, PathDoubt({}), {}, result);
  EXPECT_NEAR(std::sqrt(result.raw_approach_angle_variance),
              std::hypot(0.3, 1 / std::cos(5.2 * kDegree)) * kDegree, 1e-3 * kDegree);
  EXPECT_GT(result.approach_angle_variance, std::pow(1 * kDegree, 2));
}

LandingResult withAngle(double stddev_deg) {
  LandingResult result;
  result.approach_angle = 5 * kDegree;
  result.approach_angle_variance = std::pow(stddev_deg * kDegree, 2);
  return result;
}

TEST(LandingReport, AnAngleIsValidUnlessSomethingSpeaksAgainstIt) {
  LandingResult good = withAngle(0.5);
  judgeAngle(Pair().input(), {}, 1, good);
  EXPECT_TRUE(good.angle_valid);
  EXPECT_FALSE(good.failure);
  LandingResult refused = withAngle(0.5);
  judgeAngle(Pair().input(), kInconsistentFailure, 1, refused);
  EXPECT_FALSE(refused.angle_valid);
  EXPECT_EQ(refused.failure.message(), kInconsistentFailure.message());
}

TEST(LandingReport, AnAngleThatIsUncertainIsNotValid) {
  LandingResult result = withAngle(2);
  judgeAngle(Pair().input(), {}, 1, result);
  EXPECT_FALSE(result.angle_valid);
  EXPECT_EQ(result.failure.message(), "uncertain: approach angle has 1 sigma of 2 deg, more than 1 deg");
  LandingResult unknown = withAngle(kUnknown);
  judgeAngle(Pair().input(), {}, 1, unknown);
  EXPECT_FALSE(unknown.angle_valid);
}

TEST(LandingReport, AnAngleThatIsNoNumberIsNotValid) {
  LandingResult result = withAngle(0.5);
  result.approach_angle = kUnknown;
  judgeAngle(Pair().input(), {}, 1, result);
  EXPECT_EQ(result.failure.message(), "no_motion: the approach angle is not finite");
}

TEST(LandingReport, WhyApproachAngleHasNoneIsToldFirst) {
  Pair pair;
  pair.approach.failure = {Reason::kNoMotion, "standing still"};
  LandingResult result = withAngle(2);
  judgeAngle(pair.input(), kInconsistentFailure, 1, result);
  EXPECT_EQ(result.failure.message(), "no_motion: standing still");
  EXPECT_FALSE(result.angle_valid);
}

TEST(LandingReport, WhatRefusesAPairRefusesItsAngle) {
  const Failure otherwise{Reason::kTimeJump, "otherwise"};
  EXPECT_EQ(refusalOf(measuredHeight(10), leftOutPair(), otherwise).message(),
            kInconsistentFailure.message());
  EXPECT_EQ(refusalOf(measuredHeight(10), passingPair(), otherwise).message(), otherwise.message());
  PairVerdict angle_believed = leftOutPair();
  angle_believed.angle_refused = false;
  EXPECT_EQ(refusalOf(measuredHeight(10), angle_believed, otherwise).message(), otherwise.message());
  MeasuredHeight none = measuredHeight(10);
  none.failure = kNoPlaneFailure;
  EXPECT_EQ(refusalOf(none, leftOutPair(), otherwise).message(), kNoPlaneFailure.message())
      << "why there is no height at all comes first";
}

CameraTwist twistOf(const Pair& pair, const PairVerdict& verdict, const MotionDoubt& doubt = {}) {
  const StepScale scale = scaleOfStep(usualRig(), pair.input(), pair.ground, resultAt(10));
  return believedTwist(pair.input(), verdict, scale, doubt);
}

TEST(LandingReport, TheVelocityIsTheStepTimesTheHeightAboveThePlaneAhead) {
  Pair pair;
  EXPECT_NEAR((twistOf(pair, passingPair()).velocity - Eigen::Vector3d(0, 0, 20)).norm(), 0, 1e-9);
  pair.ground.surface.bend = 1;
  EXPECT_NEAR((twistOf(pair, passingPair()).velocity - Eigen::Vector3d(0, 0, 18)).norm(), 0, 1e-9);
}

// 0.05 degrees of 10 m in 0.1 s across, and along the 1 cm of the height and 1 % of the duration besides.
TEST(LandingReport, TheVelocityIsAsUncertainAsStepHeightAndDuration) {
  const Eigen::Matrix3d covariance =
      twistOf(Pair(), passingPair(), {0, 0.01 * 0.01}).covariance.topLeftCorner<3, 3>();
  const double of_step = std::pow(0.05 * kDegree * 10 / kStep, 2);
  EXPECT_NEAR(covariance(0, 0), of_step, 1e-9);
  EXPECT_NEAR(covariance(2, 2), of_step + std::pow(20 * 0.001, 2) + std::pow(20 * 0.01, 2), 1e-9);
}

TEST(LandingReport, TheVerticalSpeedIsAsUncertainAsTheNormalTurnsTheVelocity) {
  const Matrix6d without = twistOf(Pair(), passingPair()).covariance;
  const Matrix6d with = twistOf(Pair(), passingPair(), {std::pow(1 * kDegree, 2), 0}).covariance;
  EXPECT_NEAR(with(1, 1) - without(1, 1), std::pow(20 * kDegree, 2), 1e-9);
  EXPECT_NEAR((with - without).norm(), with(1, 1) - without(1, 1), 1e-9) << "and nothing else";
}

TEST(LandingReport, AVelocityThatHasChangedUnusuallyIsAsUncertainAsTheChange) {
  for (const double ratio : {8.0, 10.0}) {
    PairVerdict verdict = passingPair();
    verdict.velocity.change = {3, 0, 0};
    verdict.tests.add(IntegrityTest::kVelocity, std::sqrt(ratio), 1.0);
    const Matrix6d added = twistOf(Pair(), verdict).covariance - twistOf(Pair(), passingPair()).covariance;
    EXPECT_NEAR(added(0, 0), ratio > 9 ? 9 : 0, 1e-9) << "three sigmas";
  }
}

// The motion's normal leans forward by half a degree against the plane's. At the angle e below the horizon
// the depth is the height over sin e along the ray.
TEST(LandingReport, TheVelocityIsByTheDepthsOfThePlaneAndAsUncertainAsThatChangesIt) {
  constexpr double kLean = 0.5 * kDegree;
  Pair pair;
  pair.stereo.points.push_back({320, 440, 20, 0.1, true});
  pair.stereo.points.push_back({320, 260, 2, 0.1, false});  // off the plane: does not count
  pair.approach.n = normalFromPitchRoll(-kLean, 0);
  const double e = std::atan(200.0 / 500);
  const double change = std::sin(e + kLean) / std::sin(e) - 1;
  const CameraTwist twist = twistOf(pair, passingPair());
  EXPECT_NEAR(twist.velocity.z(), 20 * (1 + change), 1e-6);
  const double more =
      twist.covariance(2, 2) - (1 + change) * (1 + change) * twistOf(Pair(), passingPair()).covariance(2, 2);
  EXPECT_NEAR(std::sqrt(more), change * twist.velocity.z(), 0.02 * change * twist.velocity.z());
  pair.approach.n = normalFromPitchRoll(kLean, 0);
  EXPECT_LT(twistOf(pair, passingPair()).velocity.z(), 20) << "backward";
}

TEST(LandingReport, ReportsVelocityAndTurnWithTheirCovariance) {
  CameraTwist twist;
  twist.velocity = {1, 2, 3};
  twist.angular_velocity = {4, 5, 6};
  twist.covariance = 7 * Matrix6d::Identity();
  LandingResult result;
  reportTwist(twist, result);
  EXPECT_EQ(result.velocity, twist.velocity);
  EXPECT_EQ(result.angular_velocity, twist.angular_velocity);
  EXPECT_EQ(result.twist_covariance, twist.covariance);
}

/// All is valid and the place known, until the rig has turned by so much, known to 0.01 degrees.
LandingResult withRig(const Eigen::Vector3d& rotation_deg) {
  RigRotation rotation;
  rotation.w = kDegree * rotation_deg;
  rotation.covariance = std::pow(0.01 * kDegree, 2) * Eigen::Matrix3d::Identity();
  LandingResult result;
  result.height_valid = result.angle_valid = true;
  result.x = result.y = result.height_above_runway = 1;
  reportRig(rotation, 0.2, result);
  return result;
}

TEST(LandingReport, ARigThatIsBentForCertainWithdrawsEverything) {
  const char* names[] = {"pitch", "yaw", "roll"};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const LandingResult result = withRig(sign * 0.25 * Eigen::Vector3d::Unit(axis));
      EXPECT_FALSE(result.height_valid || result.angle_valid);
      EXPECT_EQ(result.failure.reason, Reason::kRigBent);
      EXPECT_NE(result.failure.detail.find(names[axis]), std::string::npos) << result.failure.detail;
      EXPECT_TRUE(std::isnan(result.x) && std::isnan(result.y) && std::isnan(result.height_above_runway));
    }
  }
  EXPECT_EQ(withRig({0, 0, 0.25}).failure.message(),
            "rig_bent: the right camera's roll is off its calibration by 0.25 deg with 1 sigma of 0.01 deg, "
            "at most 0.2 deg allowed");
}

TEST(LandingReport, ARigThatMayBeWithinTheLimitWithdrawsNothing) {
  const LandingResult result = withRig({0, 0, 0.22});
  EXPECT_TRUE(result.height_valid && result.angle_valid);
  EXPECT_FALSE(result.failure);
  EXPECT_EQ(result.x, 1);
  EXPECT_NEAR(result.rig_rotation.w.z(), 0.22 * kDegree, 1e-12) << "is reported";
}

TEST(LandingReport, ARigThatIsNotKnownWithdrawsNothing) {
  LandingResult result;
  result.height_valid = true;
  reportRig({}, 0.2, result);
  EXPECT_TRUE(result.height_valid);
  EXPECT_FALSE(result.rig_rotation.known());
}

}  // namespace
}  // namespace uav_landing
