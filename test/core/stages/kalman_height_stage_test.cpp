#include "uav_landing/stages/kalman_height_stage.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "support/rigs.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kStep = 0.1;  // s between pairs

StereoRig makeRig() { return test::rigOf({640, 480}, 500, {320, 240}, 320, 1.0); }

/// What stereo says of a plane at this height: 1 sigma of the height is height_stddev.
StereoDepthResult stereoAt(double stamp, double height, double pitch = -0.1, double roll = 0.05,
                           double height_stddev = 0.01) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  const Eigen::Vector3d n(std::cos(pitch) * std::sin(roll), std::cos(pitch) * std::cos(roll),
                          -std::sin(pitch));
  stereo.plane.g = n / height;
  const double along = height_stddev / (height * height);
  stereo.plane.covariance = along * along * Eigen::Matrix3d::Identity();
  return stereo;
}

StereoDepthResult noStereo(double stamp) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  stereo.failure = {Reason::kTooFewMatches, "7 of at least 20"};
  return stereo;
}

/// An approach angle of 5 degrees known to 0.1 degrees, without motion or vanishing point.
ApproachAngleResult angleAt(double stamp) {
  ApproachAngleResult approach;
  approach.stamp = stamp;
  approach.window.angle = 5 * kDegree;
  approach.window.angle_variance = std::pow(0.1 * kDegree, 2);
  approach.step.angle = 5.2 * kDegree;
  approach.step.angle_variance = std::pow(0.3 * kDegree, 2);
  approach.step.failure = {Reason::kNoMotion, "no step in this test"};
  return approach;
}

/// Feeds the same height from stamp 0 on until the stage believes it; returns the stamp of the next pair.
double settle(KalmanHeightStage& stage, double height, int pairs = 20) {
  double stamp = 0;
  for (int i = 0; i < pairs; ++i, stamp += kStep) stage.process(stereoAt(stamp, height), angleAt(stamp));
  return stamp;
}

TEST(KalmanHeightStage, SearchesUntilThereIsAPlane) {
  KalmanHeightStage stage(makeRig(), {});
  const LandingResult result = stage.process(noStereo(0), angleAt(0));
  EXPECT_EQ(result.status, Status::kSearching);
  EXPECT_EQ(result.failure.message(), "too_few_matches: 7 of at least 20");
  EXPECT_FALSE(result.height_valid);
  EXPECT_TRUE(std::isnan(result.height));
  EXPECT_TRUE(std::isnan(result.raw_height));
}

TEST(KalmanHeightStage, BelievesAHeightOnlyAfterItWasConfirmed) {
  KalmanHeightStage stage(makeRig(), {});
  for (int i = 0; i < KalmanHeightStage::kConfirmations; ++i) {
    const LandingResult result = stage.process(stereoAt(i * kStep, 10), angleAt(i * kStep));
    EXPECT_EQ(result.status, Status::kTracking);
    EXPECT_NEAR(result.height, 10, 1e-6);
    const bool last = i + 1 == KalmanHeightStage::kConfirmations;
    EXPECT_EQ(result.height_valid, last) << i;
    EXPECT_EQ(result.valid(), last);
    EXPECT_EQ(result.failure.reason, last ? Reason::kNone : Reason::kNotYet);
  }
}

TEST(KalmanHeightStage, ReportsTheMeasurementAndKeepsTheModelErrorInTheVariance) {
  KalmanHeightParameters parameters;
  parameters.height_model_error = 0.002;
  parameters.acceleration_stddev = 0.01;
  KalmanHeightStage stage(makeRig(), parameters);
  double stamp = settle(stage, 10, 300);
  const LandingResult result = stage.process(stereoAt(stamp, 10, -0.1, 0.05, 0.01), angleAt(stamp));
  EXPECT_NEAR(result.raw_height, 10, 1e-9);
  EXPECT_NEAR(result.raw_height_variance, 0.01 * 0.01 + 0.02 * 0.02, 1e-7);
  // However many pairs are averaged, the surface below differs from the plane ahead by 2 cm.
  EXPECT_GT(result.height_variance, 0.02 * 0.02);
  EXPECT_LT(result.height_variance, 1.5 * 0.02 * 0.02);
}

TEST(KalmanHeightStage, DoesNotAverageAwayTheUnevennessOfTheSurface) {
  KalmanHeightParameters parameters;
  parameters.height_model_error = 0;
  parameters.acceleration_stddev = 0.01;
  KalmanHeightStage stage(makeRig(), parameters);
  LandingResult result;
  for (int i = 0; i < 300; ++i) {
    StereoDepthResult stereo = stereoAt(i * kStep, 10);
    stereo.surface_variance = 0.03 * 0.03;
    result = stage.process(stereo, angleAt(i * kStep));
  }
  EXPECT_GT(result.height_variance, 0.03 * 0.03);
  EXPECT_LT(result.height_variance, 1.5 * 0.03 * 0.03);
}

TEST(KalmanHeightStage, IsHardlyLessCertainByASinglePairThatLeavesTheBendOpen) {
  KalmanHeightStage stage(makeRig(), {});
  LandingResult before, result;
  for (int i = 0; i <= 60; ++i) {
    StereoDepthResult stereo = stereoAt(i * kStep, 10);
    stereo.below = stereo.plane;
    // The height is 1 / g_y here, which is 0.1: 1 cm, and in the last pair 8 cm.
    stereo.below.covariance(1, 1) += std::pow(1e-4 * (i < 60 ? 1 : 8), 2);
    before = result;
    result = stage.process(stereo, angleAt(i * kStep));
  }
  EXPECT_GT(result.raw_height_variance, 0.07 * 0.07);
  EXPECT_GT(before.height_variance, 0.01 * 0.01);
  EXPECT_LT(result.height_variance, 0.25 * result.raw_height_variance);
  EXPECT_TRUE(result.height_valid);
}

TEST(KalmanHeightStage, ReportsAttitudeFromThePlaneAndYawFromTheVanishingDirection) {
  const double pitch = -8 * kDegree, roll = 12 * kDegree, yaw = 3 * kDegree;
  // R(runway <- body FLU) = Rz(yaw) Ry(-pitch) Rx(roll); optical axes are (-left, -up, forward) of the body.
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  Eigen::Matrix3d optical_from_body;
  optical_from_body << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const Eigen::Matrix3d optical_from_runway = optical_from_body * R.transpose();

  StereoDepthResult stereo = stereoAt(0, 10);
  stereo.plane.g = optical_from_runway * Eigen::Vector3d(0, 0, -1) / 10;
  ApproachAngleResult approach = angleAt(0);
  approach.vanishing_direction = optical_from_runway * Eigen::Vector3d(1, 0, 0);
  approach.vanishing_covariance = std::pow(0.2 * kDegree, 2) * Eigen::Matrix3d::Identity();

  KalmanHeightStage stage(makeRig(), {});
  const LandingResult result = stage.process(stereo, approach);
  EXPECT_NEAR(result.pitch, pitch, 1e-9);
  EXPECT_NEAR(result.roll, roll, 1e-9);
  EXPECT_NEAR(result.yaw, yaw, 1e-9);
  EXPECT_NEAR(std::sqrt(result.yaw_variance), 0.2 * kDegree, 0.05 * kDegree);
}

TEST(KalmanHeightStage, CorrectsThePitchWithTheVanishingPointButNotWithTheFusedNormal) {
  // Stereo that knows the pitch badly; the vanishing point says level, exactly.
  StereoDepthResult stereo = stereoAt(0, 10, -0.02, 0);
  stereo.plane.covariance = std::pow(0.002, 2) * Eigen::Matrix3d::Identity();
  ApproachAngleResult approach = angleAt(0);
  approach.n = Eigen::Vector3d(0.3, 0.9, 0.1).normalized();
  approach.n_covariance = 1e-12 * Eigen::Matrix3d::Identity();

  KalmanHeightStage without(makeRig(), {});
  EXPECT_NEAR(without.process(stereo, approach).pitch, -0.02, 1e-9);

  approach.vanishing_direction = Eigen::Vector3d::UnitZ();
  approach.vanishing_covariance = 1e-12 * Eigen::Matrix3d::Identity();
  KalmanHeightStage fused(makeRig(), {});
  EXPECT_NEAR(fused.process(stereo, approach).pitch, 0, 1e-6);

  KalmanHeightParameters parameters;
  parameters.fuse_vanishing_point = false;
  KalmanHeightStage off(makeRig(), parameters);
  EXPECT_NEAR(off.process(stereo, approach).pitch, -0.02, 1e-9);
}

TEST(KalmanHeightStage, LeavesOutAVanishingPointThatContradictsThePlane) {
  const StereoDepthResult stereo = stereoAt(0, 10, -0.1, 0, 0.001);
  ApproachAngleResult approach = angleAt(0);
  approach.vanishing_direction = Eigen::Vector3d::UnitZ();  // 0.1 rad off
  approach.vanishing_covariance = 1e-8 * Eigen::Matrix3d::Identity();
  KalmanHeightStage stage(makeRig(), {});
  EXPECT_NEAR(stage.process(stereo, approach).pitch, -0.1, 1e-9);
}

TEST(KalmanHeightStage, AveragesThePointsOnRequest) {
  const double h = 10, alpha = 0.1;
  StereoDepthResult stereo = stereoAt(0, h, -alpha, 0);
  for (double forward : {40.0, 60.0, 90.0}) {
    const double depth = forward * std::cos(alpha) + h * std::sin(alpha);
    const double below = h * std::cos(alpha) - forward * std::sin(alpha);
    StereoDepthResult::Point point;
    point.u = 320;
    point.v = 240 + 500 * below / depth;
    point.disparity = 500 * 1.0 / depth;
    point.disparity_stddev = 0.1;
    point.on_plane = true;
    stereo.points.push_back(point);
  }
  KalmanHeightParameters parameters;
  parameters.height_source = HeightSource::kPoints;
  KalmanHeightStage by_pitch(makeRig(), parameters);
  LandingResult result = by_pitch.process(stereo, angleAt(0));
  EXPECT_NEAR(result.raw_height, h, 1e-9);
  EXPECT_NEAR(result.points_height, h, 1e-9);

  // To the letter: 5 degrees of approach angle in place of 0.1 rad of pitch.
  parameters.reconstruction_angle = ReconstructionAngle::kApproach;
  KalmanHeightStage by_approach(makeRig(), parameters);
  const double mean_forward = (40.0 + 60.0 + 90.0) / 3;
  const double turn = 5 * kDegree - alpha;
  result = by_approach.process(stereo, angleAt(0));
  EXPECT_NEAR(result.raw_height, h * std::cos(turn) + mean_forward * std::sin(turn), 1e-9);

  ApproachAngleResult unknown = angleAt(0);
  unknown.failure = {Reason::kNoMotion, "standing still"};
  unknown.window = unknown.step = {};
  KalmanHeightStage without_angle(makeRig(), parameters);
  result = without_angle.process(stereo, unknown);
  EXPECT_EQ(result.status, Status::kSearching);
  EXPECT_EQ(result.failure.message(), "no_motion: standing still");
}

TEST(KalmanHeightStage, CoastsWithGrowingVarianceAndGivesUpAfterMaxAge) {
  KalmanHeightParameters parameters;
  parameters.max_age = 0.35;
  KalmanHeightStage stage(makeRig(), parameters);
  double stamp = settle(stage, 10);
  double variance = stage.process(stereoAt(stamp, 10), angleAt(stamp)).height_variance;
  for (int i = 1; i <= 5; ++i) {
    const LandingResult result = stage.process(noStereo(stamp + i * kStep), angleAt(stamp + i * kStep));
    EXPECT_EQ(result.status, Status::kCoasting);
    EXPECT_EQ(result.failure.reason, Reason::kTooFewMatches);
    EXPECT_TRUE(std::isnan(result.raw_height));
    EXPECT_GT(result.height_variance, variance);
    EXPECT_NEAR(result.height, 10, 0.01);
    EXPECT_EQ(result.height_valid, i <= 3) << i;
    variance = result.height_variance;
  }
}

TEST(KalmanHeightStage, IsLostAfterTheResetTimeoutAndFindsBack) {
  KalmanHeightStage stage(makeRig(), {});
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

TEST(KalmanHeightStage, RejectsAnOutlier) {
  KalmanHeightStage stage(makeRig(), {});
  const double stamp = settle(stage, 10);
  LandingResult result = stage.process(stereoAt(stamp, 14), angleAt(stamp));
  EXPECT_TRUE(result.rejected);
  EXPECT_EQ(result.consecutive_rejections, 1);
  EXPECT_EQ(result.status, Status::kCoasting);
  EXPECT_EQ(result.failure.reason, Reason::kRejected);
  EXPECT_NEAR(result.innovation, 4, 0.01);
  EXPECT_NEAR(result.height, 10, 0.01);
  result = stage.process(stereoAt(stamp + kStep, 10), angleAt(stamp + kStep));
  EXPECT_FALSE(result.rejected);
  EXPECT_EQ(result.consecutive_rejections, 0);
  EXPECT_EQ(result.resets, 0);
}

/// A straight flight in which nothing turns between the pairs, the rotation known to 0.05 degrees.
ApproachAngleResult withoutTurning(double stamp) {
  ApproachAngleResult approach = angleAt(stamp);
  approach.step.failure = {};
  approach.step.duration = kStep;
  approach.step.rotation = Eigen::Vector3d::Zero();
  approach.step.translation_over_height = {0, 0, 0.2};
  approach.step.covariance = std::pow(0.05 * kDegree, 2) * Matrix6d::Identity();
  return approach;
}

/// The pairs of a second see the same texture.
TEST(KalmanHeightStage, DoesNotClaimThatTheErrorsOfThePitchAverageOutAltogether) {
  KalmanHeightStage stage(makeRig(), {});
  std::vector<double> variances;
  for (int i = 0; i < 40; ++i) {
    ApproachAngleResult exactly = withoutTurning(i * kStep);
    exactly.step.covariance *= 1e-4;
    variances.push_back(stage.process(stereoAt(i * kStep, 10), exactly).pitch_variance);
  }
  EXPECT_LT(variances.back(), 0.6 * variances.front());
  EXPECT_GT(variances.back(), variances.front() / 3);
}

TEST(KalmanHeightStage, LeavesOutAPlaneTiltedAgainstTheRotationSinceThePairBefore) {
  KalmanHeightStage stage(makeRig(), {});
  double stamp = 0;
  LandingResult result;
  for (; stamp < 1; stamp += kStep) result = stage.process(stereoAt(stamp, 10), withoutTurning(stamp));
  ASSERT_EQ(result.status, Status::kTracking);
  const double roll = result.roll;
  // The height alone would pass the gate; the roll of 4 degrees within one pair does not.
  result = stage.process(stereoAt(stamp, 10.02, -0.1, 0.05 + 4 * kDegree), withoutTurning(stamp));
  EXPECT_EQ(result.status, Status::kCoasting);
  EXPECT_TRUE(result.rejected);
  EXPECT_EQ(result.failure.reason, Reason::kRejected);
  // 4 degrees about an axis that is pitched by 0.1 rad: 4 cos(0.1).
  EXPECT_NE(result.failure.detail.find("tilted by 3.98"), std::string::npos) << result.failure.detail;
  EXPECT_NEAR(result.raw_height, 10.02, 1e-9);
  EXPECT_NEAR(result.roll, roll, 0.1 * kDegree);
  stamp += kStep;
  EXPECT_EQ(stage.process(stereoAt(stamp, 10), withoutTurning(stamp)).status, Status::kTracking);
}

TEST(KalmanHeightStage, ABadPairDoesNotEraseWhatIsKnownOfTheGround) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto noStamp = [&](KalmanHeightStage& stage, double) {
    return stage.process(stereoAt(nan, 10), withoutTurning(nan));
  };
  const auto noMotion = [&](KalmanHeightStage& stage, double stamp) {
    ApproachAngleResult approach = withoutTurning(stamp);
    approach.step.rotation.setConstant(nan);
    approach.step.translation_over_height.setConstant(nan);
    return stage.process(stereoAt(stamp, 10), approach);
  };
  const auto noPlane = [&](KalmanHeightStage& stage, double stamp) {
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.plane.g.setConstant(nan);
    return stage.process(stereo, withoutTurning(stamp));
  };
  const std::vector<std::function<LandingResult(KalmanHeightStage&, double)>> bad = {noStamp, noMotion,
                                                                                     noPlane};
  for (size_t i = 0; i < bad.size(); ++i) {
    KalmanHeightStage stage(makeRig(), {});
    double stamp = 0;
    for (; stamp < 1; stamp += kStep) stage.process(stereoAt(stamp, 10), withoutTurning(stamp));
    bad[i](stage, stamp);
    if (i > 0) stamp += kStep;
    const LandingResult result =
        stage.process(stereoAt(stamp, 10.02, -0.1, 0.05 + 4 * kDegree), withoutTurning(stamp));
    EXPECT_NE(failedTests(result.tests).find("tilt"), std::string::npos) << i;
  }
}

TEST(KalmanHeightStage, AVerticalSpeedThatIsRefusedDoesNotWidenTheProtectionLevel) {
  KalmanHeightStage stage(makeRig(), {});
  double stamp = 0, before = 0;
  for (; stamp < 1; stamp += kStep)
    before = stage.process(stereoAt(stamp, 10), withoutTurning(stamp)).height_protection_level;
  for (const double climb : {0.12, 0.12, 0.0, 0.0, 0.0, 0.0}) {  // of 10 m in 0.05 s: 24 m/s
    ApproachAngleResult approach = withoutTurning(stamp);
    approach.step.translation_over_height.y() = -climb;
    const LandingResult result = stage.process(stereoAt(stamp, 10), approach);
    EXPECT_NEAR(result.height_protection_level, before, 0.1) << result.protection_source;
    stamp += kStep;
  }
}

/// A pair over level ground, with the points that it is seen by.
StereoDepthResult overGround(double stamp) {
  const StereoRig rig = makeRig();
  StereoDepthResult stereo = stereoAt(stamp, 10);
  for (int v = 200; v < 480; v += 10) {
    for (int u = 10; u < 640; u += 20) {
      const double disparity = stereo.plane.disparity(rig, u, v);
      if (disparity > 2) stereo.points.push_back({double(u), double(v), disparity, 0.1, true});
    }
  }
  return stereo;
}

/// The motion along it, at 20 m/s.
ApproachAngleResult alongGround(double stamp) {
  ApproachAngleResult approach = withoutTurning(stamp);
  const Eigen::Vector3d n = stereoAt(stamp, 10).plane.normal();
  approach.step.translation_over_height = 0.2 * (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
  return approach;
}

TEST(KalmanHeightStage, ATurnOfAMotionThatFailedDoesNotLiftTheGroundBelow) {
  KalmanHeightStage stage(makeRig(), {});
  double stamp = 0;
  LandingResult before;
  for (; stamp < 3; stamp += kStep) before = stage.process(overGround(stamp), alongGround(stamp));
  ASSERT_TRUE(before.height_valid) << before.failure.message();
  ApproachAngleResult failed = alongGround(stamp);
  failed.step.failure = {Reason::kMotionInconsistent, "3 of 300 matches agree"};
  failed.step.rotation.x() = -0.1;
  stage.process(overGround(stamp), failed);
  stamp += kStep;
  for (const double end = stamp + 1; stamp < end; stamp += kStep) {
    const LandingResult result = stage.process(overGround(stamp), alongGround(stamp));
    // The turn of that pair is not known, but by the normals before and after it; 0.1 rad would be metres.
    EXPECT_LT(result.height_protection_level, before.height_protection_level + 0.4)
        << result.protection_source;
  }
}

TEST(KalmanHeightStage, RecoversWithinTheTimeoutFromAWrongHeightItLockedOn) {
  KalmanHeightParameters parameters;
  parameters.integrity_monitor = false;  // else the height remembered keeps it from being valid for longer
  parameters.gate = 2;                   // narrow, so that coasting alone does not open it
  parameters.acceleration_stddev = 0.1;
  KalmanHeightStage stage(makeRig(), parameters);
  double stamp = settle(stage, 10);
  const double last_wrong = stamp - kStep;
  LandingResult result;
  do {
    result = stage.process(stereoAt(stamp, 20), angleAt(stamp));
    EXPECT_FALSE(result.height_valid && stamp - last_wrong > parameters.max_age + 1e-9);
    stamp += kStep;
  } while (result.resets == 0 && stamp < 60);
  EXPECT_LE(stamp - kStep - last_wrong, parameters.reset_timeout + 1e-6);
  EXPECT_EQ(result.resets, 1);
  EXPECT_NEAR(result.height, 20, 1e-9);
  for (int i = 1; i < KalmanHeightStage::kConfirmations; ++i, stamp += kStep)
    result = stage.process(stereoAt(stamp, 20), angleAt(stamp));
  EXPECT_TRUE(result.height_valid);
}

TEST(KalmanHeightStage, AWrongFirstPlaneIsNeverValidAndReplacedAtOnce) {
  KalmanHeightStage stage(makeRig(), {});
  EXPECT_FALSE(stage.process(stereoAt(0, 17), angleAt(0)).height_valid);
  for (int i = 1; i < 10; ++i) {
    const LandingResult result = stage.process(stereoAt(i * kStep, 10), angleAt(i * kStep));
    EXPECT_NEAR(result.height, 10, 1e-6);
    EXPECT_EQ(result.height_valid, i >= KalmanHeightStage::kConfirmations) << i;
  }
}

TEST(KalmanHeightStage, StartsAnewWhenTheStampGoesBackRepeatsOrJumpsAhead) {
  for (const double jump : {-5.0, 0.0, 30.0}) {
    KalmanHeightStage stage(makeRig(), {});
    const double last = settle(stage, 10);
    stage.process(stereoAt(last, 10), angleAt(last));
    const LandingResult result = stage.process(stereoAt(last + jump, 3), angleAt(last + jump));
    EXPECT_EQ(result.failure.reason, Reason::kTimeJump) << jump;
    EXPECT_FALSE(result.height_valid);
    EXPECT_EQ(result.resets, 1);
    EXPECT_NEAR(result.height, 3, 1e-9);
  }
}

TEST(KalmanHeightStage, AStampThatIsNotANumberIsNeverValid) {
  KalmanHeightStage stage(makeRig(), {});
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
  KalmanHeightStage stage(makeRig(), parameters);
  LandingResult result;
  for (int i = 0; i < 3; ++i)
    result = stage.process(stereoAt(i * kStep, 10, -0.1, 0, 1.0), angleAt(i * kStep));
  EXPECT_EQ(result.failure.reason, Reason::kUncertain);
  EXPECT_FALSE(result.height_valid);
  EXPECT_TRUE(result.angle_valid);
  EXPECT_FALSE(result.valid());
}

TEST(KalmanHeightStage, PublishesTheWindowsAngleAndTheStepsAsRaw) {
  KalmanHeightStage stage(makeRig(), {});
  ApproachAngleResult approach = angleAt(0);
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
  KalmanHeightStage stage(makeRig(), {});
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
  KalmanHeightStage stage(makeRig(), {});
  const LandingResult result = stage.process(stereoAt(0, 10, 0, 0), withStep(angleAt(0), 0.2));
  EXPECT_NEAR(result.velocity.y(), 2.0, 1e-9);
  EXPECT_NEAR(result.velocity.norm(), 20.0, 1e-9);
}

TEST(KalmanHeightStage, LearnsTheVerticalSpeedFromTheMotion) {
  // Descending by 0.2 m a step: two pairs whose heights are known to 5 cm only.
  const auto speed_after_two = [](bool use_motion) {
    KalmanHeightParameters parameters;
    parameters.use_motion = use_motion;
    KalmanHeightStage stage(makeRig(), parameters);
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

TEST(KalmanHeightStage, TimeoutIsLostAndNothingIsValid) {
  KalmanHeightStage stage(makeRig(), {});
  const double stamp = settle(stage, 10);
  LandingResult result = stage.timeout(stamp + 0.3);
  EXPECT_EQ(result.status, Status::kLost);
  EXPECT_EQ(result.failure.reason, Reason::kTimeout);
  EXPECT_FALSE(result.height_valid || result.angle_valid);
  EXPECT_DOUBLE_EQ(result.stamp, stamp + 0.3);
  EXPECT_EQ(stage.timeout(stamp + 5).resets, 1);
}

/// Of a runway 45 m wide from this height.
ApproachAngleResult runwayFrom(double stamp, double height) {
  ApproachAngleResult approach = angleAt(stamp);
  approach.runway.y = 0;
  approach.runway.y_variance = 1e-6;
  approach.runway.width = 45 / height;
  approach.runway.width_variance = std::pow(0.001 * approach.runway.width, 2);
  return approach;
}

TEST(KalmanHeightStage, CarriesOnByTheRunwaysWidthWithoutStereo) {
  for (const bool fuse : {true, false}) {
    KalmanHeightParameters parameters;
    parameters.fuse_width_height = fuse;
    KalmanHeightStage stage(makeRig(), parameters);
    double stamp = 0;
    for (int i = 0; i < 20; ++i, stamp += kStep) stage.process(stereoAt(stamp, 20), runwayFrom(stamp, 20));
    LandingResult result;
    for (int i = 1; i <= 20; ++i, stamp += kStep)
      result = stage.process(noStereo(stamp), runwayFrom(stamp, 20 - 0.1 * i));
    EXPECT_NEAR(result.width_height, 18, 0.02);
    EXPECT_EQ(result.height_valid, fuse);
    if (!fuse) continue;
    EXPECT_EQ(result.status, Status::kTracking);
    EXPECT_NEAR(result.height, 18, 0.1);
    // The learned width is no better than the heights that it was learned from.
    EXPECT_GE(std::sqrt(result.height_variance), 0.9 * 0.01);
  }
}

TEST(KalmanHeightStage, DoesNotBelieveAWidthThatContradictsStereo) {
  KalmanHeightParameters parameters;
  parameters.known_runway_width = 30;
  KalmanHeightStage stage(makeRig(), parameters);
  LandingResult result;
  for (int i = 0; i < 20; ++i) result = stage.process(stereoAt(i * kStep, 20), runwayFrom(i * kStep, 20));
  EXPECT_NEAR(result.width_height, 20 * 30.0 / 45, 1e-6);
  EXPECT_NEAR(result.raw_height, 20, 1e-6);
}

TEST(KalmanHeightStage, AKnownWidthThatAgreesImprovesTheHeight) {
  KalmanHeightParameters parameters;
  parameters.known_runway_width = 45;
  KalmanHeightStage stage(makeRig(), parameters);
  const StereoDepthResult stereo = stereoAt(0, 20, -0.1, 0.05, 0.2);
  const LandingResult alone = stage.process(stereo, angleAt(0));
  const LandingResult both = stage.process(stereoAt(kStep, 20, -0.1, 0.05, 0.2), runwayFrom(kStep, 20.1));
  EXPECT_GT(both.raw_height, alone.raw_height);
  EXPECT_LT(both.raw_height_variance, 0.5 * alone.raw_height_variance);
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
    KalmanHeightStage stage(makeRig(), {});
    LandingResult result;
    for (int i = 0; i < 50; ++i) result = stage.process(bentRig(i * kStep, roll_deg), angleAt(i * kStep));
    EXPECT_EQ(result.failure.reason, Reason::kRigBent);
    EXPECT_NE(result.failure.detail.find("roll"), std::string::npos) << result.failure.detail;
    EXPECT_NE(result.failure.detail.find("0.2 deg allowed"), std::string::npos) << result.failure.detail;
    EXPECT_FALSE(result.height_valid || result.angle_valid);
    EXPECT_NEAR(result.rig_rotation.w.z(), roll_deg * kDegree, 0.03 * kDegree);
  }
}

TEST(KalmanHeightStage, ReportsABentRigWithinTheLimitAndNoneWhenNotWatching) {
  KalmanHeightParameters parameters;
  KalmanHeightStage watching(makeRig(), parameters);
  parameters.rig_watch = false;
  KalmanHeightStage blind(makeRig(), parameters);
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

}  // namespace
}  // namespace uav_landing
