#include "landing/watch/pair_monitor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "support/degree.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::kStep;
using test::usualRig;

constexpr double kHeight = 10;

/// 20 m/s over level ground, with a height that the pairs before agree on.
class Pairs {
 public:
  explicit Pairs(const KalmanHeightParameters& parameters = {}) : monitor(usualRig(), parameters) {}

  PairMonitor monitor;
  StereoDepthResult stereo = test::stereoAt(1, kHeight);
  ApproachAngleResult approach = levelFlight();
  Ground ground = test::groundOf(stereo.plane);
  MeasuredHeight measured = test::measuredHeight(kHeight);

  /// The next pair.
  PairVerdict check() {
    stereo.stamp = approach.stamp += kStep;
    return monitor.check(test::pairOf(stereo, approach), ground, measured, test::priorAt(kHeight), 0);
  }
  PairVerdict checkSeveral(int pairs) {
    while (--pairs > 0) check();
    return check();
  }
  PairVerdict checkWithRowAgreement(double agreement) {
    stereo.row_agreement = agreement;
    return check();
  }
  static std::string failed(const PairVerdict& verdict) { return test::failedOf(verdict.tests); }

 private:
  static ApproachAngleResult levelFlight() {
    ApproachAngleResult approach = test::stepAlone(1);
    const Eigen::Vector3d n = test::stereoAt(1, kHeight).plane.normal();
    approach.n = n;
    approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
    approach.step.translation_over_height = 0.2 * (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
    approach.step.covariance = 1e-8 * Matrix6d::Identity();
    return approach;
  }
};

TEST(PairMonitor, APairOfAHealthyFlightPasses) {
  Pairs pairs;
  for (int i = 0; i < 20; ++i) {
    const PairVerdict verdict = pairs.check();
    EXPECT_EQ(Pairs::failed(verdict), "");
    EXPECT_FALSE(verdict.leftOut() || verdict.angle_refused || verdict.confirming);
    EXPECT_TRUE(verdict.rig_believed && verdict.knowsDown());
  }
}

TEST(PairMonitor, MatchesThatDoNotHoldAcrossTheRowsLeaveThePairOut) {
  Pairs pairs;
  EXPECT_EQ(Pairs::failed(pairs.checkWithRowAgreement(0.6)), "");
  const PairVerdict verdict = pairs.checkWithRowAgreement(0.4);
  EXPECT_EQ(Pairs::failed(verdict), "row_agreement");
  EXPECT_EQ(verdict.failure.message(), "inconsistent: row_agreement");
  EXPECT_TRUE(verdict.angle_refused);
  EXPECT_FALSE(verdict.rig_believed);
}

TEST(PairMonitor, APairThatHasNoHeightAnywayTeachesNothingAndHasNoAngleEither) {
  Pairs pairs;
  pairs.measured = test::noHeight();
  const PairVerdict verdict = pairs.checkWithRowAgreement(0.4);
  EXPECT_FALSE(verdict.leftOut());
  EXPECT_TRUE(verdict.angle_refused);
  EXPECT_FALSE(verdict.rig_believed);
}

TEST(PairMonitor, ARepeatedPictureLeavesThePairOutAndOnlyTheRightOneTakesTheAngle) {
  for (const bool left : {false, true}) {
    Pairs pairs;
    (left ? pairs.stereo.left_repeated : pairs.stereo.right_repeated) = true;
    const PairVerdict verdict = pairs.check();
    EXPECT_EQ(verdict.failure.message(), "inconsistent: repeated_image");
    EXPECT_EQ(verdict.angle_refused, !left) << "with the left one it is that of the pair before";
  }
}

TEST(PairMonitor, AsManyPairsInARowMustPassAsFailedBeforeUpToThree) {
  for (const int failures : {1, 2, 3, 5}) {
    Pairs pairs;
    for (int i = 0; i < failures; ++i) EXPECT_TRUE(pairs.checkWithRowAgreement(0.4).leftOut());
    // One that passes by chance, and a failure again: it begins anew.
    if (failures > 1) {
      EXPECT_TRUE(pairs.checkWithRowAgreement(0.9).confirming) << failures;
      EXPECT_FALSE(pairs.checkWithRowAgreement(0.4).confirming) << failures;
    }
    const int needed = failures == 1 ? 1 : 3;
    for (int i = 1; i < needed; ++i) {
      const PairVerdict verdict = pairs.checkWithRowAgreement(0.9);
      EXPECT_TRUE(verdict.leftOut() && verdict.confirming) << failures << ", " << i;
      EXPECT_TRUE(verdict.rig_believed) << "nothing speaks against it";
    }
    EXPECT_FALSE(pairs.checkWithRowAgreement(0.9).leftOut()) << failures;
    EXPECT_FALSE(pairs.checkWithRowAgreement(0.9).leftOut()) << failures;
  }
}

TEST(PairMonitor, SaysHowManyPairsHavePassedAgain) {
  Pairs pairs;
  for (int i = 0; i < 3; ++i) pairs.checkWithRowAgreement(0.4);
  EXPECT_EQ(pairs.checkWithRowAgreement(0.9).failure.message(),
            "inconsistent: 1 of 3 pairs that pass the tests again");
}

TEST(PairMonitor, ABaselineInAnotherDirectionThanCalibratedLeavesThePairOut) {
  const auto failed = [](double forward, double stddev) {
    Pairs pairs;
    pairs.stereo.baseline_direction.t = {0, forward};
    pairs.stereo.baseline_direction.covariance = stddev * stddev * Eigen::Matrix2d::Identity();
    return Pairs::failed(pairs.check());
  };
  // 4.8 sigma of two numbers are exceeded once in a hundred thousand; a calibration is not perfect either.
  EXPECT_EQ(failed(0.048, 0.01), "");
  EXPECT_EQ(failed(0.06, 0.01), "baseline_direction");
}

// 10 cm of way on a metre of baseline are 6 degrees. Where nobody knows the way it may be any.
TEST(PairMonitor, ABaselineThatTheSkewOfThePairExplainsIsNoFault) {
  constexpr double kSkew = 0.005;  // s
  for (const bool step_known : {true, false}) {
    for (const double share : {1.0, 0.0, -1.0}) {
      Pairs pairs;
      const Eigen::Vector3d velocity = kHeight / kStep * pairs.approach.step.translation_over_height;
      pairs.stereo.skew = kSkew;
      pairs.stereo.baseline_direction.t = share * kSkew / usualRig().baseline * velocity.tail<2>();
      pairs.stereo.baseline_direction.covariance = 1e-6 * Eigen::Matrix2d::Identity();
      if (!step_known) pairs.approach.step = ApproachAngleResult::Motion();
      EXPECT_EQ(Pairs::failed(pairs.check()), !step_known || share == 1 ? "" : "baseline_direction")
          << step_known << share;
    }
  }
}

// The ground's slope is in the imu's covariance: 0.6 degrees, 1 sigma. The limit of 1e-5 with two degrees of
// freedom is 4.8 sigma: 2.9 degrees.
TEST(PairMonitor, AnImuThatContradictsTheGroundsNormalIsNamedAndLeavesNoPairOut) {
  for (const double off_deg : {0.0, 2.0, -2.0, 4.0, -4.0}) {
    Pairs pairs;
    pairs.approach.imu.normal = normalFromPitchRoll(-0.1 + off_deg * kDegree, 0.05);
    pairs.approach.imu.normal_covariance = std::pow(0.6 * kDegree, 2) * Eigen::Matrix3d::Identity();
    const PairVerdict verdict = pairs.check();
    EXPECT_EQ(Pairs::failed(verdict), std::abs(off_deg) > 3 ? "imu" : "") << off_deg;
    EXPECT_NEAR(verdict.tests.result(IntegrityTest::kImu).difference, std::abs(off_deg) * kDegree, 1e-4);
    EXPECT_FALSE(verdict.leftOut() || verdict.angle_refused);
  }
}

TEST(PairMonitor, AMotionThatAsksForAnotherNormalIsNamedAndDoesNotKnowWhatIsDown) {
  for (const double off_deg : {0.0, 2.0}) {
    Pairs pairs;
    pairs.approach.step.normal = normalFromPitchRoll(-0.1 + off_deg * kDegree, 0.05);
    pairs.approach.step.normal_covariance = std::pow(0.1 * kDegree, 2) * Eigen::Matrix3d::Identity();
    const PairVerdict verdict = pairs.check();
    EXPECT_EQ(Pairs::failed(verdict), off_deg > 0 ? "motion_normal" : "");
    EXPECT_EQ(verdict.knowsDown(), off_deg == 0);
    EXPECT_FALSE(verdict.leftOut());
    pairs.stereo.left_repeated = true;
    EXPECT_EQ(Pairs::failed(pairs.check()), "repeated_image") << "of an image once more it is an old one";
  }
}

TEST(PairMonitor, AVanishingPointOffTheHorizonIsNamedAndDoesNotKnowWhatIsDown) {
  for (const double off_deg : {0.0, 2.0}) {
    Pairs pairs;
    const Eigen::Vector3d n = pairs.stereo.plane.normal();
    const Eigen::Vector3d ahead = (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
    const double off = off_deg * kDegree;
    pairs.approach.vanishing_direction = std::cos(off) * ahead + std::sin(off) * n;
    pairs.approach.vanishing_covariance = std::pow(0.1 * kDegree, 2) * Eigen::Matrix3d::Identity();
    const PairVerdict verdict = pairs.check();
    EXPECT_EQ(Pairs::failed(verdict), off_deg > 0 ? "vanishing_point" : "");
    const TestResult& test = verdict.tests.result(IntegrityTest::kVanishingPoint);
    EXPECT_NEAR(test.difference, std::sin(off), 1e-9);
    // The plane's tilt is known to 0.01 m of 10 m.
    EXPECT_NEAR(test.variance, std::pow(0.1 * kDegree, 2) + 0.001 * 0.001, 1e-9);
    EXPECT_EQ(verdict.knowsDown(), off_deg == 0);
    EXPECT_FALSE(verdict.leftOut());
  }
}

/// A height of 10 m that is so much higher without the far and the left part of the image.
MeasuredHeight withoutRegions(double without_far, double without_left) {
  MeasuredHeight measured = test::measuredHeight(kHeight);
  const auto set = [&](FaultySource source, double height) {
    measured.without[static_cast<int>(source)] = {height, 0.1 * 0.1, {}};
  };
  for (int i = 0; i < kImageRegions; ++i) set(faultySource(static_cast<ImageRegion>(i)), kHeight);
  set(FaultySource::kFar, kHeight + without_far);
  set(FaultySource::kLeft, kHeight + without_left);
  return measured;
}

TEST(PairMonitor, AHeightThatHangsOnOnePartOfTheImageLeavesThePairOut) {
  Pairs pairs;
  pairs.measured = withoutRegions(0.3, -0.2);
  const PairVerdict passes = pairs.check();
  EXPECT_EQ(Pairs::failed(passes), "");
  EXPECT_NEAR(passes.tests.result(IntegrityTest::kImageRegions).difference, 0.3, 1e-9) << "the largest";
  pairs.measured = withoutRegions(0.3, -0.6);
  const PairVerdict fails = pairs.check();
  EXPECT_EQ(fails.failure.message(), "inconsistent: image_regions");
  EXPECT_NEAR(fails.tests.result(IntegrityTest::kImageRegions).difference, -0.6, 1e-9);
  // One of five exceeds 4.4 sigma five times as often as a single one.
  EXPECT_NEAR(fails.tests.result(IntegrityTest::kImageRegions).limit, chiSquareLimit(1e-5 / 5, 1), 1e-9);
}

TEST(PairMonitor, AWidthThatContradictsStereoIsNamedAndLeavesNoPairOut) {
  Pairs pairs;
  pairs.measured.stereo_height = kHeight;
  pairs.measured.stereo_variance = 0.03 * 0.03;
  pairs.measured.width_height = 10.3;
  pairs.measured.width_height_variance = 0.04 * 0.04;
  const PairVerdict verdict = pairs.check();
  EXPECT_EQ(Pairs::failed(verdict), "runway_width");
  EXPECT_NEAR(verdict.tests.result(IntegrityTest::kRunwayWidth).ratio, 36, 1e-6) << "0.3 m of 0.05 m";
  EXPECT_FALSE(verdict.leftOut());
  pairs.measured.by_width = true;
  EXPECT_EQ(Pairs::failed(pairs.check()), "") << "a height is not compared with itself";
}

// Both the last step and the window enter the published angle.
TEST(PairMonitor, RowsThatMoveTheAngleByMoreThanItsClaimCoversAreNamedAndLeaveNoPairOut) {
  using Motion = ApproachAngleResult::Motion;
  for (Motion ApproachAngleResult::*const which :
       {&ApproachAngleResult::step, &ApproachAngleResult::window}) {
    Pairs pairs;
    EXPECT_FALSE(pairs.check().tests.result(IntegrityTest::kRowMotion).possible()) << "a global shutter";
    for (Motion* motion : {&pairs.approach.step, &pairs.approach.window}) {
      motion->row_motion = 0;
      motion->row_motion_limit = 0.001;
    }
    EXPECT_TRUE(pairs.check().tests.result(IntegrityTest::kRowMotion).possible());
    (pairs.approach.*which).row_motion = 0.0009;
    const PairVerdict covered = pairs.check();
    EXPECT_EQ(Pairs::failed(covered), "");
    EXPECT_TRUE(covered.knowsDown());
    (pairs.approach.*which).row_motion = 0.002;
    const PairVerdict verdict = pairs.check();
    EXPECT_EQ(Pairs::failed(verdict), "row_motion");
    EXPECT_NEAR(verdict.tests.result(IntegrityTest::kRowMotion).ratio, 4, 1e-9);
    EXPECT_FALSE(verdict.leftOut() || verdict.angle_refused || verdict.knowsDown());
    pairs.stereo.left_repeated = true;
    EXPECT_FALSE(pairs.check().tests.result(IntegrityTest::kRowMotion).possible()) << "of the pair before";
  }
}

TEST(PairMonitor, ATiltedPlaneLeavesThePairOutEvenWithoutTheMonitor) {
  for (const bool monitor : {false, true}) {
    KalmanHeightParameters parameters;
    parameters.integrity_monitor = monitor;
    Pairs pairs(parameters);
    pairs.ground.tilted = true;
    pairs.ground.tilt = 4 * kDegree;
    pairs.ground.tilt_ratio = 30;
    const PairVerdict verdict = pairs.check();
    EXPECT_EQ(
        verdict.failure.message(),
        "rejected: the ground plane is tilted by 4 deg against the pairs before and the rotation since");
    EXPECT_EQ(Pairs::failed(verdict), "tilt");
    EXPECT_FALSE(verdict.angle_refused) << "its doubt says how wrong it may be";
    pairs.measured = test::noHeight();
    EXPECT_FALSE(pairs.check().leftOut()) << "there is nothing to leave out";
  }
}

TEST(PairMonitor, WithoutTheMonitorNothingElseIsTested) {
  KalmanHeightParameters parameters;
  parameters.integrity_monitor = false;
  Pairs pairs(parameters);
  EXPECT_EQ(Pairs::failed(pairs.checkWithRowAgreement(0.4)), "");
}

// 20 m/s do not become 0 in a tenth of a second.
TEST(PairMonitor, APictureThatStandsStillInFlightLeavesPairsOutUntilItMovesAgain) {
  Pairs pairs;
  pairs.checkSeveral(10);
  const Eigen::Vector3d flight = pairs.approach.step.translation_over_height;
  pairs.approach.step.translation_over_height.setZero();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(pairs.check().failure.message(), "inconsistent: standstill") << i;
  pairs.approach.step.failure = {Reason::kMotionInconsistent, "3 of 300 matches agree"};
  EXPECT_EQ(pairs.check().failure.message(),
            "inconsistent: standstill: no motion has been seen since for long enough");
  pairs.approach.step.failure = {};
  pairs.approach.step.translation_over_height = flight;
  int until = 1;
  while (pairs.check().leftOut() && until < 20) ++until;
  EXPECT_LE(until, 6) << "three that move, and three that pass";
  EXPECT_FALSE(pairs.check().leftOut());
}

TEST(PairMonitor, AStepThatTheVelocityContradictsIsNamedAndLeavesNoPairOut) {
  Pairs pairs;
  pairs.checkSeveral(10);
  pairs.approach.step.translation_over_height *= 3;
  const PairVerdict verdict = pairs.check();
  EXPECT_EQ(Pairs::failed(verdict), "velocity");
  EXPECT_NEAR(verdict.velocity.change.norm(), 40, 0.1) << "m/s";
  EXPECT_FALSE(verdict.leftOut() || verdict.angle_refused);
}

/// Rows that show this roll of the right camera, known to 0.003 degrees.
RigRotation rowsOf(double roll) {
  RigRotation rows;
  rows.w = {0, 0, roll};
  rows.covariance = std::pow(0.003 * kDegree, 2) * Eigen::Matrix3d::Identity();
  return rows;
}

TEST(PairMonitor, ARigThatTurnsALittleIsTheNewOneAfterASecond) {
  Pairs pairs;
  pairs.stereo.vertical_rotation = rowsOf(0);
  pairs.checkSeveral(20);
  pairs.stereo.vertical_rotation = rowsOf(0.08 * kDegree);
  int until = 0;
  PairVerdict verdict(test::noTests());
  do {
    EXPECT_FALSE(pairs.monitor.doubtsRig(pairs.stereo.vertical_rotation)) << "a small change";
    verdict = pairs.check();
    EXPECT_EQ(Pairs::failed(verdict), "rig_rotation");
    EXPECT_TRUE(verdict.leftOut());
    EXPECT_FALSE(verdict.rig_believed);
    ++until;
  } while (!verdict.rig_turned && until < 50);
  EXPECT_NEAR(until * kStep, 1, 1.01 * kStep);
  EXPECT_NEAR(verdict.rig_turned->w.z(), 0.08 * kDegree, 1e-6);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Pairs::failed(verdict = pairs.check()), "") << i;
  EXPECT_FALSE(verdict.leftOut());
}

TEST(PairMonitor, RowsThatAreFarOffSayNothingOfTheRig) {
  Pairs pairs;
  pairs.stereo.vertical_rotation = rowsOf(0);
  pairs.checkSeveral(20);
  EXPECT_FALSE(pairs.monitor.doubtsRig(rowsOf(0)));
  EXPECT_TRUE(pairs.monitor.doubtsRig(rowsOf(0.5 * kDegree)));
}

}  // namespace
}  // namespace uav_landing
