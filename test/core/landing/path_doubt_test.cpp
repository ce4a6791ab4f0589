#include "landing/watch/path_doubt.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/degree.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::kStep;

constexpr double kPitch = -0.1, kOwn = 0.05 * kDegree;

Eigen::Matrix3d across(const Eigen::Vector3d& direction, double stddev) {
  return stddev * stddev * (Eigen::Matrix3d::Identity() - direction * direction.transpose());
}

/// Level flight over level ground, which the plane and the approach angle's normal agree about.
struct Flight {
  StereoDepthResult stereo = test::stereoAt(10, 10, kPitch, 0, 0.002);
  ApproachAngleResult approach = test::stepAlone(10);
  Ground ground = test::groundOf(stereo.plane);
  PairTests tests = test::noTests();
  PathDoubt doubt;

  explicit Flight(const KalmanHeightParameters& parameters = {}) : doubt(parameters) {
    approach.n = stereo.plane.normal();
    approach.n_covariance = stereo.plane.normalCovariance();
    approach.step.translation_over_height = {0, 0.2 * std::sin(kPitch), 0.2 * std::cos(kPitch)};
    approach.step.angle = 0;
    approach.step.angle_variance = 1e-6;
  }
  /// The runway's vanishing point is off the plane's horizon by so many sigmas, as the test has found.
  void seeVanishingPoint(double sigmas, double stddev) {
    const double below = -kPitch - sigmas * stddev;
    approach.vanishing_direction = {0, -std::sin(below), std::cos(below)};
    approach.vanishing_covariance = across(approach.vanishing_direction, stddev);
    tests = test::noTests();
    tests.add(IntegrityTest::kVanishingPoint, sigmas * stddev, stddev * stddev);
  }
  void seeNoVanishingPoint() {
    approach.vanishing_direction.setConstant(kUnknown);
    approach.vanishing_covariance.setConstant(kUnknown);
    tests = test::noTests();
  }
  /// The images' motion asks for a normal that is off by these angles.
  void seeMotionNormal(double by_pitch, double by_roll = 0) {
    approach.step.normal = normalFromPitchRoll(kPitch + by_pitch, by_roll);
    approach.step.normal_covariance = across(approach.step.normal, kOwn);
  }
  void setGroundNormal(const Eigen::Vector3d& n) { ground.normal = {n, ground.normal->covariance()}; }
  PairInput pair() const { return test::pairOf(stereo, approach); }
  double variance() const {
    const PairInput in = pair();
    return doubt.variance(in, ground, in.step());
  }
  double stddev() const { return std::sqrt(variance()); }
  /// So many pairs, and what they leave.
  double stddevAfter(int pairs) {
    for (int i = 0; i < pairs; ++i) {
      stereo.stamp = approach.stamp += kStep;
      doubt.update(pair(), ground, tests);
    }
    return stddev();
  }
};

KalmanHeightParameters withoutRigWatch() {
  KalmanHeightParameters parameters;
  parameters.rig_watch = false;
  return parameters;
}

TEST(PathDoubt, SourcesThatAgreeLeaveNone) {
  Flight flight;
  flight.seeVanishingPoint(0, 0.15 * kDegree);
  EXPECT_NEAR(flight.stddev(), 0, 1e-9);
  // Of a fault that nothing shows the odds are 1 : 999.
  EXPECT_NEAR(flight.stddevAfter(10), 0.15 * kDegree / std::sqrt(1000), 1e-3 * kDegree);
}

// By less than a test needs: a right camera that has turned in yaw makes a plane that is tilted.
TEST(PathDoubt, IsAContradictionTimesTheProbabilityThatItIsAFault) {
  constexpr double kStddev = 0.15 * kDegree;
  for (const double sigmas : {1.0, 3.0, 3.6}) {
    Flight flight;
    flight.seeVanishingPoint(sigmas, kStddev);
    // A fault explains the contradiction, noise makes it with exp(-sigmas^2 / 2); 1 : 999 beforehand.
    const double likelier = std::exp(0.5 * sigmas * sigmas), probability = likelier / (likelier + 999);
    const double expected = std::sqrt(probability * (sigmas * sigmas + 1)) * kStddev;
    EXPECT_NEAR(flight.stddevAfter(3), expected, 0.01 * expected) << sigmas;
  }
}

TEST(PathDoubt, ASinglePairThatContradictsSaysNothing) {
  Flight flight;
  flight.seeVanishingPoint(0, 0.15 * kDegree);
  flight.stddevAfter(3);
  flight.seeVanishingPoint(4, 0.15 * kDegree);
  EXPECT_LT(flight.stddevAfter(1), 0.03 * kDegree);
  EXPECT_GT(flight.stddevAfter(1), 0.3 * kDegree) << "two of three do";
}

TEST(PathDoubt, APairWithoutAVanishingPointIsDoubtedForThoseBeforeItWithinASecond) {
  Flight flight;
  flight.seeVanishingPoint(4, 0.15 * kDegree);
  const double before = flight.stddevAfter(3);
  flight.seeNoVanishingPoint();
  EXPECT_NEAR(flight.stddevAfter(1), before, 1e-9);
  EXPECT_NEAR(flight.stddevAfter(8), before, 1e-9);
  EXPECT_NEAR(flight.stddevAfter(3), 0, 1e-9);
}

TEST(PathDoubt, AVanishingPointThatLeapsAndFailsItsTestIsOfOtherLines) {
  Flight flight;
  flight.seeVanishingPoint(0, 0.02 * kDegree);
  flight.stddevAfter(5);
  flight.seeVanishingPoint(50, 0.02 * kDegree);
  EXPECT_LT(flight.stddevAfter(5), 0.01 * kDegree);
  EXPECT_GT(flight.stddevAfter(10), 0.9 * kDegree) << "unless it stays for more than a second";
}

TEST(PathDoubt, IsAsLargeAsTheMotionsOwnNormalContradictsThePlane) {
  constexpr double kDifference = 0.5 * kDegree;
  Flight flight(withoutRigWatch());
  flight.seeMotionNormal(0);
  flight.stddevAfter(3);
  flight.seeMotionNormal(kDifference);
  flight.stddevAfter(2);
  EXPECT_NEAR(flight.stddevAfter(1), std::hypot(kDifference, kOwn), 0.01 * kDifference);
  flight.seeMotionNormal(0);
  EXPECT_LT(flight.stddevAfter(3), 0.1 * kOwn);
}

TEST(PathDoubt, ANormalThatRollsAboutTheFlightHardlyChangesTheAngle) {
  Flight flight(withoutRigWatch());
  flight.seeMotionNormal(0, 0.5 * kDegree);
  EXPECT_NEAR(flight.stddevAfter(3), kOwn, 0.2 * kOwn) << "as uncertain as that normal, and no more";
}

TEST(PathDoubt, IsTheTiltOfAPlaneThatThePairsBeforeContradict) {
  Flight flight;
  flight.ground.tilted = true;
  flight.setGroundNormal(normalFromPitchRoll(kPitch + 3 * kDegree, 0));
  EXPECT_NEAR(flight.stddev(), 3 * kDegree, 0.01 * kDegree);
  flight.setGroundNormal(normalFromPitchRoll(kPitch, 3 * kDegree));
  EXPECT_NEAR(flight.stddev(), 0, 0.01 * kDegree) << "about the direction of flight";
}

// 1 sigma of the plane's normal is 0.0002 rad, and as much of the average.
TEST(PathDoubt, APlaneThatTurnsWithinNoiseIsNotDoubtedAndOneThatTurnsFurtherIs) {
  Flight flight;
  flight.setGroundNormal(normalFromPitchRoll(kPitch + 0.0004, 0));
  EXPECT_EQ(flight.stddev(), 0);
  flight.setGroundNormal(normalFromPitchRoll(kPitch + 0.003, 0));
  EXPECT_NEAR(flight.stddev(), std::sqrt(0.003 * 0.003 - 3.84 * 2 * 0.0002 * 0.0002), 1e-5);
}

TEST(PathDoubt, IsTheRigsRotationThatTheAnglesNormalDoesNotKnowOf) {
  Flight watched, unwatched(withoutRigWatch());
  for (Flight* flight : {&watched, &unwatched})
    flight->approach.n_covariance = across(flight->approach.n, 0.0001);  // the plane's: 0.0002
  EXPECT_NEAR(watched.stddev(), std::sqrt(3) * 0.0001, 1e-7);
  EXPECT_EQ(unwatched.stddev(), 0);
}

TEST(PathDoubt, CountsForMoreOnASteepPath) {
  Flight flight;
  flight.ground.tilted = true;
  flight.setGroundNormal(normalFromPitchRoll(kPitch + 1 * kDegree, 0));
  const double level = flight.stddev();
  flight.approach.step.angle = 60 * kDegree;
  EXPECT_NEAR(flight.stddev(), 2 * level, 1e-6);
}

TEST(PathDoubt, OfAMotionWhoseRowsMoveOnTheirOwnNothingIsKnown) {
  Flight flight;
  flight.approach.step.row_motion_limit = 0.001;
  flight.approach.step.row_motion = 0.0009;
  EXPECT_LT(flight.stddev(), 1e-3);
  flight.approach.step.row_motion = 0.002;
  EXPECT_EQ(flight.stddev(), 1);
}

TEST(PathDoubt, ThereIsNoneWhereNoNormalIsKnown) {
  Flight flight;
  flight.approach.n.setConstant(kUnknown);
  flight.approach.n_covariance.setConstant(kUnknown);
  EXPECT_EQ(flight.variance(), 0);
  flight.ground = {};
  EXPECT_EQ(flight.stddevAfter(3), 0);
}

TEST(NormalOfAngle, IsTheMeanOfTheOneGivenAndTheMotionsOwnAsWeightsSay) {
  ApproachAngleResult approach;
  approach.n = normalFromPitchRoll(kPitch, 0);
  approach.n_covariance = across(approach.n, 0.002);
  ApproachAngleResult::Motion motion;
  EXPECT_EQ(normalOfAngle(approach, motion)->vector(), approach.n) << "the motion has none";
  motion.normal = normalFromPitchRoll(kPitch + 0.01, 0);
  motion.normal_covariance = across(motion.normal, 0.001);
  const GroundNormal mean = normalOfAngle(approach, motion).value();
  EXPECT_NEAR(pitchOf(mean.vector()), kPitch + 0.8 * 0.01, 1e-5);
  EXPECT_NEAR(std::sqrt(pitchVariance(mean.vector(), mean.covariance())), 0.002 / std::sqrt(5), 1e-6);
}

}  // namespace
}  // namespace uav_landing
