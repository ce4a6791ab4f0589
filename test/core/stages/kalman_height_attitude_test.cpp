#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

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
  approach.other_runway_probability = 0;

  KalmanHeightStage stage(usualRig(), {});
  const LandingResult result = stage.process(stereo, approach);
  EXPECT_NEAR(result.pitch, pitch, 1e-9);
  EXPECT_NEAR(result.roll, roll, 1e-9);
  EXPECT_NEAR(result.yaw, yaw, 1e-9);
  EXPECT_NEAR(std::sqrt(result.yaw_variance), 0.2 * kDegree, 0.05 * kDegree);
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
    approach.other_runway_probability = 0;
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
  approach.other_runway_probability = 0;
  return approach;
}

/// The same without a vanishing point in view.
ApproachAngleResult levelFlight(const StereoDepthResult& stereo) {
  ApproachAngleResult approach = levelFlight(stereo, 0, 1);
  approach.vanishing_direction.setConstant(kUnknown);
  approach.vanishing_covariance.setConstant(kUnknown);
  return approach;
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
