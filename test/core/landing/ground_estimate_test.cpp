#include "landing/height/ground_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "rig/rig_rotation.h"
#include "support/degree.h"
#include "support/ground_matches.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::kStep;
using test::pairOf;
using test::stepAlone;
using test::stereoAt;
using test::usualRig;
using test::withoutTurning;

KalmanHeightParameters withRigWatch(bool watch) {
  KalmanHeightParameters parameters;
  parameters.rig_watch = watch;
  return parameters;
}

/// What a first pair says.
Ground firstGround(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                   const KalmanHeightParameters& parameters = {}) {
  return GroundEstimate(usualRig(), parameters).propose(pairOf(stereo, approach), false, false);
}

Eigen::Matrix3d across(const Eigen::Vector3d& direction, double stddev) {
  return stddev * stddev * (Eigen::Matrix3d::Identity() - direction * direction.transpose());
}

TEST(GroundEstimate, SaysWhyThereIsNoPlane) {
  const Ground ground = firstGround(test::noStereo(0), withoutTurning(0));
  EXPECT_EQ(ground.failure.message(), "too_few_matches: 7 of at least 20");
  EXPECT_FALSE(ground.plane.valid());
  EXPECT_EQ(ground.positionNormalOr(Eigen::Vector3d::UnitY()), Eigen::Vector3d::UnitY());
}

TEST(GroundEstimate, APlaneWhoseHeightIsUncertainByAThirdIsNone) {
  EXPECT_FALSE(firstGround(stereoAt(0, 10, -0.1, 0, 2.5), withoutTurning(0)).failure);
  const Ground ground = firstGround(stereoAt(0, 10, -0.1, 0, 3.5), withoutTurning(0));
  EXPECT_EQ(ground.failure.message(),
            "uncertain: the height of the ground plane has 1 sigma of 0.35 of itself, more than 0.3");
}

TEST(GroundEstimate, IsThePlaneByStereoWhereNothingElseIsKnown) {
  const StereoDepthResult stereo = stereoAt(0, 10);
  const Ground ground = firstGround(stereo, withoutTurning(0), withRigWatch(false));
  for (const GroundPlane& plane : {ground.plane, ground.alone, ground.surface.below}) {
    EXPECT_NEAR((plane.g - stereo.plane.g).norm(), 0, 1e-12);
    EXPECT_NEAR(std::sqrt(plane.heightVariance()), 0.01, 1e-9);
  }
  EXPECT_EQ(ground.positionNormalOr(Eigen::Vector3d::UnitY()), stereo.plane.normal());
  EXPECT_FALSE(ground.tilted);
}

TEST(GroundEstimate, AVanishingPointTurnsThePlaneButTheFusedNormalOfTheAngleDoesNot) {
  // Stereo that knows the pitch badly; the vanishing point says level, exactly.
  StereoDepthResult stereo = stereoAt(0, 10, -0.02, 0);
  stereo.plane.covariance = std::pow(0.002, 2) * Eigen::Matrix3d::Identity();
  ApproachAngleResult approach = withoutTurning(0);
  approach.n = Eigen::Vector3d(0.3, 0.9, 0.1).normalized();
  approach.n_covariance = 1e-12 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(pitchOf(firstGround(stereo, approach).plane.normal()), -0.02, 1e-9);

  approach.vanishing_direction = Eigen::Vector3d::UnitZ();
  approach.vanishing_covariance = 1e-12 * Eigen::Matrix3d::Identity();
  const Ground fused = firstGround(stereo, approach);
  EXPECT_NEAR(pitchOf(fused.plane.normal()), 0, 1e-6);
  EXPECT_NEAR(pitchOf(fused.alone.normal()), -0.02, 1e-9) << "by stereo alone";

  KalmanHeightParameters off;
  off.fuse_vanishing_point = false;
  EXPECT_NEAR(pitchOf(firstGround(stereo, approach, off).plane.normal()), -0.02, 1e-9);
}

TEST(GroundEstimate, AVanishingPointThatContradictsThePlaneIsLeftOut) {
  ApproachAngleResult approach = withoutTurning(0);
  approach.vanishing_direction = Eigen::Vector3d::UnitZ();  // 0.1 rad off
  approach.vanishing_covariance = 1e-8 * Eigen::Matrix3d::Identity();
  for (const bool watch : {false, true}) {
    const Ground ground = firstGround(stereoAt(0, 10, -0.1, 0, 0.001), approach, withRigWatch(watch));
    EXPECT_NEAR(pitchOf(ground.plane.normal()), -0.1, 1e-9) << watch;
  }
}

TEST(GroundEstimate, ThePlaneIsTurnedByTheMotionsOwnNormalAsWeightsSay) {
  constexpr double kPitch = -0.1, kOff = 0.3 * kDegree, kOwn = 0.05 * kDegree;
  // 0.02 m of 10 m is 0.11 degrees across, too.
  const double by_stereo = 0.02 / 10, share = by_stereo * by_stereo / (by_stereo * by_stereo + kOwn * kOwn);
  ApproachAngleResult approach = stepAlone(0);
  approach.step.normal = normalFromPitchRoll(kPitch + kOff, -kOff);
  approach.step.normal_covariance = across(approach.step.normal, kOwn);
  for (const bool watch : {false, true}) {
    for (const bool fuse : {false, true}) {
      KalmanHeightParameters parameters = withRigWatch(watch);
      parameters.fuse_motion_normal = fuse;
      const GroundNormal normal =
          firstGround(stereoAt(0, 10, kPitch, 0, 0.02), approach, parameters).normal.value();
      EXPECT_NEAR(pitchOf(normal.vector()), kPitch + (fuse ? share * kOff : 0), 0.02 * kOff) << watch << fuse;
      EXPECT_NEAR(rollOf(normal.vector()), fuse ? -share * kOff : 0, 0.02 * kOff) << watch << fuse;
      EXPECT_NEAR(std::sqrt(pitchVariance(normal.vector(), normal.covariance())),
                  by_stereo * (fuse ? std::sqrt(1 - share) : 1), 0.05 * by_stereo)
          << watch << fuse;
    }
  }
}

// d height = -height^2 n.dg, and a bias of all disparities is an error of g along the optical axis of bias /
// fb.
TEST(GroundEstimate, TheBiasOfARigThatIsNotWatchedIsCommonToAllPairs) {
  constexpr double kHeight = 30, kBias = 0.1;  // m, px
  StereoDepthResult stereo = stereoAt(0, kHeight, -0.25);
  stereo.disparity_bias_stddev = kBias;
  stereo.plane.covariance(2, 2) += std::pow(kBias / usualRig().fb(), 2);
  GroundEstimate estimate(usualRig(), withRigWatch(false));
  const double expected = std::pow(kHeight * kHeight * std::sin(0.25) * kBias / usualRig().fb(), 2);
  EXPECT_NEAR(estimate.propose(pairOf(stereo, withoutTurning(0)), false, false).rig_variance, expected,
              1e-9 * expected);
  const Ground blind = estimate.propose(pairOf(test::noStereo(kStep), withoutTurning(kStep)), false, false);
  EXPECT_NEAR(blind.rig_variance, expected, 1e-9 * expected) << "without a plane as before";
}

TEST(GroundEstimate, WhatVerticalDisparitiesAreWrongByIsCommonToThePlanesAlone) {
  StereoDepthResult stereo = stereoAt(0, 10);
  stereo.row_covariance(1, 1) = 1e-6;
  stereo.plane.covariance += stereo.row_covariance;
  const Ground ground = firstGround(stereo, withoutTurning(0), withRigWatch(false));
  EXPECT_NEAR((ground.alone_common - stereo.row_covariance).norm(), 0, 1e-12);
  EXPECT_NEAR((ground.common - stereo.row_covariance).norm(), 0, 1e-12);
}

// Sideways by 2 m/s on a baseline of 1 m: in 5 ms all disparities change by 1 %.
TEST(GroundEstimate, APairThatIsSkewedIsLessCertainByTheWayInBetween) {
  ApproachAngleResult approach = withoutTurning(0);
  approach.step.translation_over_height = Eigen::Vector3d(2 * kStep, 0, 0) / 10;
  StereoDepthResult stereo = stereoAt(0, 10);
  stereo.skew = 0.005;
  const Ground ground = firstGround(stereo, approach, withRigWatch(false));
  EXPECT_NEAR(ground.plane.heightVariance(), 0.01 * 0.01 + 0.1 * 0.1, 1e-6);
}

/// Pairs from one height one after the other.
class Flight {
 public:
  explicit Flight(const KalmanHeightParameters& parameters = {}) : estimate(usualRig(), parameters) {}

  GroundEstimate estimate;
  ApproachAngleResult approach = withoutTurning(0);

  Ground fly(StereoDepthResult stereo) {
    stereo.stamp = approach.stamp = stamp_;
    stamp_ += kStep;
    const Ground ground = estimate.propose(pairOf(stereo, approach), false, true);
    estimate.commit(true, std::nullopt);
    return ground;
  }
  Ground fly(double pitch = -0.1, double roll = 0.05) { return fly(stereoAt(0, 10, pitch, roll)); }

 private:
  double stamp_ = 0;
};

TEST(GroundEstimate, APlaneTiltedAgainstThePairsBeforeAndTheRotationSinceIsNamed) {
  Flight flight;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(flight.fly().tilted) << i;
  const Ground tilted = flight.fly(-0.1, 0.05 + 4 * kDegree);
  EXPECT_TRUE(tilted.tilted);
  // 4 degrees about an axis that is pitched by 0.1 rad.
  EXPECT_NEAR(tilted.tilt, 4 * kDegree * std::cos(0.1), 0.01 * kDegree);
  EXPECT_GT(tilted.tilt_ratio, AttitudeFilter::kGate.squared());
  const Eigen::Vector3d before = normalFromPitchRoll(-0.1, 0.05);
  EXPECT_NEAR((tilted.positionNormalOr(Eigen::Vector3d::UnitZ()) - before).norm(), 0, 1e-6);
  EXPECT_FALSE(flight.fly().tilted);
}

TEST(GroundEstimate, ATurnOfTheCameraIsNoTilt) {
  Flight flight;
  for (int i = 0; i < 10; ++i) flight.fly();
  flight.approach.step.rotation = {-2 * kDegree, 0, 0};  // nose up
  EXPECT_FALSE(flight.fly(-0.1 + 2 * kDegree).tilted);
}

TEST(GroundEstimate, WithoutAveragingEveryPlaneStandsForItself) {
  KalmanHeightParameters parameters;
  parameters.average_attitude = false;
  Flight flight(parameters);
  for (int i = 0; i < 10; ++i) flight.fly();
  const Ground ground = flight.fly(-0.1, 0.05 + 4 * kDegree);
  EXPECT_FALSE(ground.tilted);
  EXPECT_TRUE(std::isnan(ground.tilt_ratio));
  EXPECT_NEAR(rollOf(ground.normal->vector()), 0.05 + 4 * kDegree, 1e-9);
}

// The pairs of a second see the same texture.
TEST(GroundEstimate, TheErrorsOfThePitchAverageOutInPart) {
  Flight flight;
  flight.approach.step.covariance *= 1e-4;
  std::vector<double> variances;
  for (int i = 0; i < 40; ++i) {
    const GroundNormal normal = flight.fly().normal.value();
    variances.push_back(pitchVariance(normal.vector(), normal.covariance()));
  }
  EXPECT_LT(variances.back(), 0.6 * variances.front());
  EXPECT_GT(variances.back(), variances.front() / 3);
}

// The camera nods by 0.1 degrees from pair to pair, and planes are off by 0.05 degrees this way and that.
TEST(GroundEstimate, APictureOnceMoreCountsOnceForTheAttitude) {
  constexpr double kNod = 0.1 * kDegree, kError = 0.05 * kDegree;
  GroundEstimate once(usualRig(), {}), twice(usualRig(), {});
  for (int i = 0; i < 40; ++i) {
    const double stamp = kStep * i, error = i % 3 == 0 ? kError : -0.5 * kError;
    StereoDepthResult stereo = stereoAt(stamp, 10, -0.1 + kNod * i + error);
    ApproachAngleResult approach = withoutTurning(stamp);
    approach.step.rotation = {-kNod, 0, 0};
    const GroundNormal expected = once.propose(pairOf(stereo, approach), false, true).normal.value();
    const GroundNormal shown = twice.propose(pairOf(stereo, approach), false, true).normal.value();
    EXPECT_NEAR((shown.vector() - expected.vector()).norm(), 0, 1e-9) << i;
    EXPECT_NEAR(shown.covariance().trace(), expected.covariance().trace(),
                1e-6 * expected.covariance().trace());

    stereo.stamp = stamp + 0.5 * kStep;
    stereo.left_repeated = true;
    const Ground again = twice.propose(pairOf(stereo, test::angleAt(stereo.stamp)), false, true);
    EXPECT_TRUE(std::isnan(again.tilt_ratio)) << i;
  }
}

TEST(GroundEstimate, AnUnusualTurnIsDoubtedUntilAPlaneConfirmsIt) {
  Flight flight;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(flight.fly().turn_doubted);
  flight.approach.step.rotation = {-6 * kDegree, 0, 0};  // 60 degrees per second
  EXPECT_TRUE(flight.fly(test::noStereo(0)).turn_doubted);
  EXPECT_FALSE(flight.fly(-0.1 + 12 * kDegree).turn_doubted);
}

/// A pair of a right camera that has rolled by so much, as vertical disparities and the plane show it.
StereoDepthResult rolledRig(double roll) {
  StereoDepthResult stereo = stereoAt(0, 10);
  stereo.points = test::matchesOn(usualRig(), stereo.plane.g);
  stereo.disparity_bias_stddev = 0.1;
  stereo.plane.covariance(2, 2) += std::pow(0.1 / usualRig().fb(), 2);
  stereo.vertical_rotation.w = {0, 0, roll};
  stereo.vertical_rotation.covariance = std::pow(0.003 * kDegree, 2) * Eigen::Matrix3d::Identity();
  stereo.plane.g +=
      planeByRotation(usualRig(), stereo.points, PlaneVector(stereo.plane.g)) * stereo.vertical_rotation.w;
  return stereo;
}

TEST(GroundEstimate, ThePlaneIsFreedOfTheRigsRotation) {
  constexpr double kRoll = 0.1 * kDegree;
  const Eigen::Vector3d right = stereoAt(0, 10).plane.normal();
  const double seen = (rolledRig(kRoll).plane.normal() - right).norm();
  ASSERT_GT(seen, 0.1 * kDegree);
  Flight watched, unwatched(withRigWatch(false));
  Ground ground;
  for (int i = 0; i < 20; ++i) ground = watched.fly(rolledRig(kRoll));
  EXPECT_NEAR(watched.estimate.rigRotation().w.z(), kRoll, 0.1 * kRoll);
  EXPECT_LT((ground.plane.normal() - right).norm(), 0.1 * seen);
  EXPECT_LT((ground.alone.normal() - right).norm(), 0.1 * seen);
  for (int i = 0; i < 20; ++i) ground = unwatched.fly(rolledRig(kRoll));
  EXPECT_NEAR((ground.plane.normal() - right).norm(), seen, 1e-6);
}

TEST(GroundEstimate, NothingIsLearnedOfTheRigFromRowsThatAreDoubted) {
  GroundEstimate estimate(usualRig(), {});
  for (int i = 0; i < 20; ++i) {
    StereoDepthResult stereo = rolledRig(0.1 * kDegree);
    stereo.stamp = kStep * i;
    estimate.propose(pairOf(stereo, withoutTurning(stereo.stamp)), true, true);
    estimate.commit(true, std::nullopt);
  }
  EXPECT_NEAR(estimate.rigRotation().w.z(), 0, 0.01 * kDegree);
}

// A plane that the motion's own normal contradicts looks like a right camera that has turned.
TEST(GroundEstimate, NothingIsLearnedOfTheRigFromPairsThatAreNotBelieved) {
  double yaw[2];
  for (const bool believed : {false, true}) {
    GroundEstimate estimate(usualRig(), {});
    for (int i = 0; i < 20; ++i) {
      StereoDepthResult stereo = stereoAt(kStep * i, 30, -0.1, 0, 0.02);
      stereo.points = test::matchesOn(usualRig(), stereo.plane.g);
      stereo.disparity_bias_stddev = 0.1;
      stereo.plane.covariance(2, 2) += std::pow(0.1 / usualRig().fb(), 2);
      ApproachAngleResult approach = stepAlone(stereo.stamp);
      approach.step.normal = normalFromPitchRoll(-0.1 + 0.1 * kDegree, 0);
      approach.step.normal_covariance = across(approach.step.normal, 0.02 * kDegree);
      estimate.propose(pairOf(stereo, approach), false, true);
      estimate.commit(believed, std::nullopt);
    }
    yaw[believed] = estimate.rigRotation().w.y();
  }
  EXPECT_EQ(yaw[false], 0);
  EXPECT_GT(std::abs(yaw[true]), 0.001 * kDegree);
}

TEST(GroundEstimate, ARigThatHasTurnedIsTheNewOneFromThenOn) {
  Flight flight;
  for (int i = 0; i < 100; ++i) flight.fly(rolledRig(0));
  RigRotation turned = rolledRig(0.08 * kDegree).vertical_rotation;
  turned.covariance(1, 1) = 1;  // rows say nothing of the yaw
  flight.estimate.commit(true, turned);
  flight.fly(rolledRig(0.08 * kDegree));
  EXPECT_NEAR(flight.estimate.rigRotation().w.z(), 0.08 * kDegree, 0.01 * kDegree);
}

}  // namespace
}  // namespace uav_landing
