#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "support/degree.h"
#include "support/ground_matches.h"
#include "support/kalman_height_inputs.h"
#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

using test::angleAt;
using test::kDegree;
using test::kStep;
using test::stereoAt;
using test::usualRig;
using test::withoutTurning;

TEST(KalmanHeightAttitude, ReportsAttitudeFromThePlaneAndYawFromTheVanishingDirection) {
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

  KalmanHeightStage stage(usualRig(), {});
  const LandingResult result = stage.process(stereo, approach);
  EXPECT_NEAR(result.pitch, pitch, 1e-9);
  EXPECT_NEAR(result.roll, roll, 1e-9);
  EXPECT_NEAR(result.yaw, yaw, 1e-9);
  EXPECT_NEAR(std::sqrt(result.yaw_variance), 0.2 * kDegree, 0.05 * kDegree);
}

TEST(KalmanHeightAttitude, AVanishingDirectionThatLeapsTurnsNoYaw) {
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  const auto fly = [&](double yaw_deg, bool repeated = false) {
    StereoDepthResult stereo = stereoAt(stamp, 10, 0, 0);
    stereo.left_repeated = repeated;
    ApproachAngleResult approach = withoutTurning(stamp);
    approach.vanishing_direction = {std::sin(yaw_deg * kDegree), 0, std::cos(yaw_deg * kDegree)};
    approach.vanishing_covariance = std::pow(0.03 * kDegree, 2) * Eigen::Matrix3d::Identity();
    stamp += kStep;
    return stage.process(stereo, approach);
  };
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(fly(0.02 * (i % 2)).yaw, 0.02 * (i % 2) * kDegree, 1e-9) << i;
  const LandingResult leapt = fly(0.7);
  EXPECT_NEAR(leapt.yaw, 0.02 * kDegree, 1e-9);
  // As certain as the pair before with a rotation known to 0.05 degrees.
  EXPECT_NEAR(std::sqrt(leapt.yaw_variance), std::hypot(0.03, 0.05) * kDegree, 0.02 * kDegree);
  EXPECT_NEAR(fly(0.7, true).yaw, 0.02 * kDegree, 1e-9) << "the same image again";
  EXPECT_NEAR(fly(0).yaw, 0, 1e-9);
  EXPECT_NEAR(fly(0, true).yaw, 0, 1e-9);
  // What stays is the runway: the turn may have been wrong.
  for (int i = 0; i < 4; ++i) fly(0);
  for (const double yaw : {0.0, 0.0, 0.7, 0.7}) EXPECT_NEAR(fly(0.7).yaw, yaw * kDegree, 1e-9) << yaw;
}

TEST(KalmanHeightAttitude, CorrectsThePitchWithTheVanishingPointButNotWithTheFusedNormal) {
  // Stereo that knows the pitch badly; the vanishing point says level, exactly.
  StereoDepthResult stereo = stereoAt(0, 10, -0.02, 0);
  stereo.plane.covariance = std::pow(0.002, 2) * Eigen::Matrix3d::Identity();
  ApproachAngleResult approach = angleAt(0);
  approach.n = Eigen::Vector3d(0.3, 0.9, 0.1).normalized();
  approach.n_covariance = 1e-12 * Eigen::Matrix3d::Identity();

  KalmanHeightStage without(usualRig(), {});
  EXPECT_NEAR(without.process(stereo, approach).pitch, -0.02, 1e-9);

  approach.vanishing_direction = Eigen::Vector3d::UnitZ();
  approach.vanishing_covariance = 1e-12 * Eigen::Matrix3d::Identity();
  KalmanHeightStage fused(usualRig(), {});
  EXPECT_NEAR(fused.process(stereo, approach).pitch, 0, 1e-6);

  KalmanHeightParameters parameters;
  parameters.fuse_vanishing_point = false;
  KalmanHeightStage off(usualRig(), parameters);
  EXPECT_NEAR(off.process(stereo, approach).pitch, -0.02, 1e-9);
}

TEST(KalmanHeightAttitude, LeavesOutAVanishingPointThatContradictsThePlane) {
  const StereoDepthResult stereo = stereoAt(0, 10, -0.1, 0, 0.001);
  ApproachAngleResult approach = angleAt(0);
  approach.vanishing_direction = Eigen::Vector3d::UnitZ();  // 0.1 rad off
  approach.vanishing_covariance = 1e-8 * Eigen::Matrix3d::Identity();
  KalmanHeightStage stage(usualRig(), {});
  EXPECT_NEAR(stage.process(stereo, approach).pitch, -0.1, 1e-9);
}

/// The pairs of a second see the same texture.
TEST(KalmanHeightAttitude, DoesNotClaimThatTheErrorsOfThePitchAverageOutAltogether) {
  KalmanHeightStage stage(usualRig(), {});
  std::vector<double> variances;
  for (int i = 0; i < 40; ++i) {
    ApproachAngleResult exactly = withoutTurning(i * kStep);
    exactly.step.covariance *= 1e-4;
    variances.push_back(stage.process(stereoAt(i * kStep, 10), exactly).pitch_variance);
  }
  EXPECT_LT(variances.back(), 0.6 * variances.front());
  EXPECT_GT(variances.back(), variances.front() / 3);
}

TEST(KalmanHeightAttitude, LeavesOutAPlaneTiltedAgainstTheRotationSinceThePairBefore) {
  KalmanHeightStage stage(usualRig(), {});
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

TEST(KalmanHeightAttitude, AnAngleAgainstAPlaneThatTheVanishingPointContradictsIsAsUncertainAsTheyDiffer) {
  constexpr double kPitch = -0.1, kDifference = 1.2 * kDegree;
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  LandingResult result;
  const auto fly = [&](double pitch, double vanishing_elevation) {
    const StereoDepthResult stereo = stereoAt(stamp, 10, pitch, 0, 0.002);
    ApproachAngleResult approach = withoutTurning(stamp);
    approach.n = stereo.plane.normal();
    approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
    approach.step.translation_over_height = {0, 0.2 * std::sin(kPitch), 0.2 * std::cos(kPitch)};
    approach.window = approach.step;
    approach.window.angle = 0;
    approach.window.angle_variance = 1e-6;
    approach.vanishing_direction = {0, -std::sin(vanishing_elevation), std::cos(vanishing_elevation)};
    approach.vanishing_covariance = 1e-8 * Eigen::Matrix3d::Identity();
    result = stage.process(stereo, approach);
    stamp += kStep;
  };
  while (stamp < 2) fly(kPitch, -kPitch);
  ASSERT_TRUE(result.angle_valid) << result.failure.message();
  EXPECT_NEAR(std::sqrt(result.approach_angle_variance), 1e-3, 1e-4);

  // The plane has not moved, so that it is the vanishing point of other lines, unless that goes on.
  const double leapt = stamp;
  while (stamp < leapt + 0.85) {
    fly(kPitch, -kPitch - kDifference);
    ASSERT_EQ(failedTests(result.tests), "vanishing_point");
    EXPECT_TRUE(result.angle_valid) << stamp << ": " << result.failure.message();
  }
  for (int i = 0; i < 3; ++i) fly(kPitch, -kPitch - kDifference);
  ASSERT_EQ(failedTests(result.tests), "vanishing_point");
  EXPECT_FALSE(result.angle_valid) << "longer than a second";
  EXPECT_NEAR(std::sqrt(result.approach_angle_variance), kDifference, 0.1 * kDegree);

  for (int i = 0; i < 20; ++i) fly(kPitch, -kPitch);
  ASSERT_TRUE(result.angle_valid) << result.failure.message();
  fly(kPitch + kDifference, -kPitch);
  ASSERT_EQ(failedTests(result.tests), "vanishing_point");
  EXPECT_FALSE(result.angle_valid) << "the plane has turned";
}

/// Of a level flight over level ground, as stereo and a vanishing point at this elevation see it.
ApproachAngleResult levelFlight(const StereoDepthResult& stereo, double vanishing_elevation,
                                double vanishing_stddev) {
  ApproachAngleResult approach = withoutTurning(stereo.stamp);
  approach.n = stereo.plane.normal();
  approach.n_covariance = stereo.plane.normalCovariance();
  const Eigen::Vector3d ahead(0, approach.n.z(), -approach.n.y());
  approach.step.translation_over_height = -0.2 * ahead.normalized();
  approach.step.covariance *= 1e-2;
  approach.window = approach.step;
  approach.window.angle = 0;
  approach.window.angle_variance = std::pow(0.06 * kDegree, 2);
  approach.vanishing_direction = {0, -std::sin(vanishing_elevation), std::cos(vanishing_elevation)};
  approach.vanishing_covariance = std::pow(vanishing_stddev, 2) * Eigen::Matrix3d::Identity();
  return approach;
}

/// The same without a vanishing point in view.
ApproachAngleResult levelFlight(const StereoDepthResult& stereo) {
  ApproachAngleResult approach = levelFlight(stereo, 0, 1);
  approach.vanishing_direction.setConstant(kUnknown);
  approach.vanishing_covariance.setConstant(kUnknown);
  return approach;
}

// A right camera that has turned in yaw makes a plane that is tilted, and nothing but the vanishing point
// contradicts it, by less than a test needs.
TEST(KalmanHeightAttitude, AnAngleIsAsUncertainAsAContradictionThatNoTestRefusesIsLikelyToBeAFault) {
  constexpr double kPitch = -0.1, kVanishing = 0.15 * kDegree;
  // 1 sigma of the plane's normal is 0.002 m over 10 m. The odds of a fault are 1 : 999 beforehand.
  const double stddev = std::hypot(kVanishing, 0.002 / 10);
  for (const double sigmas : {0.0, 1.0, 3.0, 3.6}) {
    SCOPED_TRACE(sigmas);
    KalmanHeightStage stage(usualRig(), {});
    LandingResult result;
    for (double stamp = 0; stamp < 2; stamp += kStep) {
      const StereoDepthResult stereo = stereoAt(stamp, 10, kPitch, 0, 0.002);
      result = stage.process(stereo, levelFlight(stereo, -kPitch - sigmas * stddev, kVanishing));
    }
    ASSERT_EQ(failedTests(result.tests), "");
    ASSERT_TRUE(result.angle_valid) << result.failure.message();
    const double likelier = std::exp(0.5 * sigmas * sigmas), probability = likelier / (likelier + 999);
    const double off = sigmas * stddev;
    const double expected = std::pow(0.06 * kDegree, 2) + probability * (off * off + kVanishing * kVanishing);
    EXPECT_NEAR(std::sqrt(result.approach_angle_variance), std::sqrt(expected), 0.02 * std::sqrt(expected));
  }
}

// Without a vanishing point only what moves in the image contradicts a plane that a turned right camera
// tilts.
TEST(KalmanHeightAttitude, AnAngleIsAsUncertainAsTheMotionsOwnNormalContradictsThePlane) {
  constexpr double kPitch = -0.1, kOwn = 0.06 * kDegree, kDifference = 0.5 * kDegree;
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  const auto fly = [&](double difference) {
    const StereoDepthResult stereo = stereoAt(stamp, 10, kPitch, 0, 0.002);
    ApproachAngleResult approach = levelFlight(stereo);
    approach.window.normal = normalFromPitchRoll(kPitch + difference, 0);
    approach.window.normal_covariance =
        kOwn * kOwn *
        (Eigen::Matrix3d::Identity() - approach.window.normal * approach.window.normal.transpose());
    stamp += kStep;
    return stage.process(stereo, approach);
  };
  LandingResult result;
  while (stamp < 2) result = fly(0.5 * kOwn);
  ASSERT_TRUE(result.angle_valid) << result.failure.message();
  const double agreeing = std::sqrt(result.approach_angle_variance);
  EXPECT_NEAR(agreeing, 0.06 * kDegree, 0.003 * kDegree);
  result = fly(kDifference);
  EXPECT_NEAR(std::sqrt(result.approach_angle_variance), agreeing, 0.003 * kDegree) << "a single pair";
  for (int i = 0; i < 2; ++i) result = fly(kDifference);
  EXPECT_TRUE(result.height_valid) << result.failure.message();
  EXPECT_NEAR(std::sqrt(result.approach_angle_variance), kDifference, 0.05 * kDegree);
  while (stamp < 4) result = fly(0);
  EXPECT_NEAR(std::sqrt(result.approach_angle_variance), agreeing, 0.003 * kDegree);
}

TEST(KalmanHeightAttitude, ThePlaneIsTurnedByTheMotionsOwnNormalAsWeightsSay) {
  constexpr double kPitch = -0.1, kOff = 0.3 * kDegree, kOwn = 0.05 * kDegree;
  // 0.02 m of 10 m is 0.11 degrees across, too.
  const double by_stereo = 0.02 / 10, share = by_stereo * by_stereo / (by_stereo * by_stereo + kOwn * kOwn);
  for (const bool watch : {false, true}) {
    for (const bool fuse : {false, true}) {
      KalmanHeightParameters parameters;
      parameters.rig_watch = watch;
      parameters.fuse_motion_normal = fuse;
      KalmanHeightStage stage(usualRig(), parameters);
      const StereoDepthResult stereo = stereoAt(0, 10, kPitch, 0, 0.02);
      ApproachAngleResult approach = levelFlight(stereo);
      const Eigen::Vector3d n = normalFromPitchRoll(kPitch + kOff, -kOff);
      approach.window.normal = n;
      approach.window.normal_covariance = kOwn * kOwn * (Eigen::Matrix3d::Identity() - n * n.transpose());
      const LandingResult result = stage.process(stereo, approach);
      EXPECT_NEAR(result.pitch, kPitch + (fuse ? share * kOff : 0), 0.02 * kOff) << watch << fuse;
      EXPECT_NEAR(result.roll, fuse ? -share * kOff : 0, 0.02 * kOff) << watch << fuse;
      EXPECT_NEAR(std::sqrt(result.pitch_variance), by_stereo * (fuse ? std::sqrt(1 - share) : 1),
                  0.05 * by_stereo)
          << watch << fuse;
    }
  }
}

TEST(KalmanHeightAttitude, APairWithoutAVanishingPointIsAsUncertainAsThoseBeforeThatContradicted) {
  constexpr double kPitch = -0.1, kDifference = 0.8 * kDegree;
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  LandingResult result;
  for (; stamp < 1; stamp += kStep) {
    const StereoDepthResult stereo = stereoAt(stamp, 10, kPitch, 0, 0.002);
    result = stage.process(stereo, levelFlight(stereo, -kPitch - kDifference, 0.15 * kDegree));
  }
  ASSERT_EQ(failedTests(result.tests), "vanishing_point");
  const double before = result.approach_angle_variance;
  const StereoDepthResult stereo = stereoAt(stamp, 10, kPitch, 0, 0.002);
  result = stage.process(stereo, levelFlight(stereo));
  EXPECT_EQ(failedTests(result.tests), "");
  EXPECT_NEAR(std::sqrt(result.approach_angle_variance), std::sqrt(before), 0.01 * kDegree);
}

TEST(KalmanHeightAttitude, AnAngleAgainstAPlaneThatHasTurnedIsAsUncertainAsTheTurnUntilThePairsAgree) {
  constexpr double kPitch = -0.1, kTurn = 0.25 * kDegree;  // within what the ground's unevenness may do
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  const auto stddev = [&](double pitch) {
    const StereoDepthResult stereo = stereoAt(stamp, 10, pitch, 0, 0.002);
    ApproachAngleResult approach = levelFlight(stereo);
    stamp += kStep;
    const LandingResult result = stage.process(stereo, approach);
    EXPECT_EQ(failedTests(result.tests), "");
    return std::sqrt(result.approach_angle_variance);
  };
  while (stamp < 1) stddev(kPitch);
  // What noise of 0.011 degrees does is no turn.
  EXPECT_NEAR(stddev(kPitch + 0.015 * kDegree), 0.06 * kDegree, 1e-9);
  EXPECT_NEAR(stddev(kPitch), 0.06 * kDegree, 1e-9);
  // The mean of a second has a part of the new one in it.
  const double turned = stddev(kPitch + kTurn);
  EXPECT_GT(turned, 0.5 * kTurn);
  EXPECT_LT(turned, std::hypot(kTurn, 0.06 * kDegree));
  while (stamp < 6) stddev(kPitch + kTurn);
  EXPECT_NEAR(stddev(kPitch + kTurn), 0.06 * kDegree, 0.005 * kDegree);
}

// A constant disparity of 0.3 px, 1 sigma, tilts the plane by h / (f b) of it. That of a yaw grows with 1 +
// x^2, to 1.4 at the image's borders, and pitch and roll of the rig are open besides.
TEST(KalmanHeightAttitude, AnAngleIsAsUncertainAsTheRigsRotationThatItsNormalDoesNotKnowOf) {
  const StereoRig rig = usualRig();
  constexpr double kBias = 0.3, kHeight = 10;
  for (const bool known : {true, false}) {
    KalmanHeightStage stage(rig, {});
    LandingResult result;
    for (double stamp = 0; stamp < 1; stamp += kStep) {
      StereoDepthResult stereo = stereoAt(stamp, kHeight, -0.1, 0, 0.002);
      stereo.points = test::matchesOn(rig, stereo.plane.g);
      stereo.disparity_bias_stddev = kBias;
      const Eigen::Matrix3d alone = stereo.plane.normalCovariance();
      stereo.plane.covariance(2, 2) += std::pow(kBias / rig.fb(), 2);
      ApproachAngleResult approach = levelFlight(stereo, 0, 1);
      approach.vanishing_direction.setConstant(kUnknown);
      approach.vanishing_covariance.setConstant(kUnknown);
      if (!known) approach.n_covariance = alone;
      result = stage.process(stereo, approach);
    }
    const double more = std::sqrt(result.approach_angle_variance - std::pow(0.06 * kDegree, 2));
    const double share = more / (kHeight * kBias / rig.fb());
    if (known)
      EXPECT_LT(share, 0.6) << "but for what the constant leaves out";
    else
      EXPECT_TRUE(share > 1 && share < 1.25) << share;
  }
}

TEST(KalmanHeightAttitude, AnAngleAgainstATiltedPlaneIsAsUncertainAsTheTilt) {
  constexpr double kTilt = 3 * kDegree;
  for (const double limit_deg : {1.0, 4.0}) {
    KalmanHeightParameters parameters;
    parameters.max_angle_stddev_deg = limit_deg;
    KalmanHeightStage stage(usualRig(), parameters);
    double stamp = 0;
    LandingResult result;
    const auto fly = [&](double pitch) {
      const StereoDepthResult stereo = stereoAt(stamp, 10, pitch);
      ApproachAngleResult approach = withoutTurning(stamp);
      approach.n = stereo.plane.normal();
      approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
      const Eigen::Vector3d level = stereoAt(0, 10).plane.normal();
      approach.step.translation_over_height =
          0.2 * (Eigen::Vector3d::UnitZ() - level.z() * level).normalized();
      approach.window.duration = 0.5;
      approach.window.rotation = approach.step.rotation;
      approach.window.translation_over_height = {0, 0, 1};
      approach.window.covariance = approach.step.covariance;
      result = stage.process(stereo, approach);
      stamp += kStep;
    };
    while (stamp < 1) fly(-0.1);
    ASSERT_TRUE(result.angle_valid);
    const double before = result.approach_angle_variance;
    fly(-0.1 + kTilt);
    ASSERT_NE(failedTests(result.tests).find("tilt"), std::string::npos);
    // 5 degrees down the angle turns by 1 / cos(5 degrees) of the tilt, and the axis is not quite level.
    EXPECT_NEAR(std::sqrt(result.approach_angle_variance - before), kTilt, 0.03 * kTilt);
    EXPECT_EQ(result.angle_valid, limit_deg > 3);
    fly(-0.1);
    EXPECT_TRUE(result.angle_valid) << result.failure.message();
  }
}

}  // namespace
}  // namespace uav_landing
