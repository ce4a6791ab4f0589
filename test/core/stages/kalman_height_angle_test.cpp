#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/degree.h"
#include "support/ground_matches.h"
#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

using test::kDegree;

constexpr double kT = 0.05, kWindow = 0.5;
constexpr double kStddev = 0.06 * kDegree;

/// A camera that looks 4 degrees down and moves by so many metres ahead, down and aside; the angle is that.
class Flight {
 public:
  double turn = 0;       // about the camera's down axis, from pair to pair, rad
  double agreement = 1;  // of the rows
  double misjudged = 0;  // by which the normal of the movement leans forward against the plane's, rad

  LandingResult fly(double ahead, double down, double aside = 0) {
    const double duration = pending_ + kT;
    pending_ = 0;
    height_ -= down;
    StereoDepthResult stereo;
    stereo.stamp = stamp_;
    stereo.plane.g = normal_ / height_;
    stereo.plane.covariance = 1e-8 * Eigen::Matrix3d::Identity();
    stereo.row_agreement = agreement;
    stereo.points = test::matchesOn(test::usualRig(), stereo.plane.g);
    ApproachAngleResult approach;
    approach.stamp = stamp_;
    approach.n = Eigen::AngleAxisd(misjudged, Eigen::Vector3d::UnitX()) * normal_;
    approach.n_covariance = stereo.plane.normalCovariance();
    ApproachAngleResult::Motion& step = approach.step;
    step.duration = duration;
    step.rotation = {0, turn, 0};
    const Eigen::Vector3d forward(0, -std::sin(4 * kDegree), std::cos(4 * kDegree));
    step.translation_over_height =
        (ahead * forward + down * normal_ + Eigen::Vector3d(aside, 0, 0)) / height_;
    step.covariance = 1e-8 * Matrix6d::Identity();
    step.angle = std::atan2(down, std::hypot(ahead, aside));
    step.angle_variance = kStddev * kStddev;
    approach.window = step;
    approach.window.duration = kWindow;
    stamp_ += kT;
    return stage_.process(stereo, approach);
  }
  /// The left picture of the pair before once more: the next step is over the time of both.
  LandingResult repeat() {
    StereoDepthResult stereo;
    stereo.stamp = stamp_;
    stereo.left_repeated = true;
    stereo.failure = {Reason::kNoPlane, ""};
    ApproachAngleResult approach;
    approach.stamp = stamp_;
    approach.failure = approach.step.failure = approach.window.failure = {Reason::kNoMotion, ""};
    stamp_ += kT;
    pending_ += kT;
    return stage_.process(stereo, approach);
  }

 private:
  KalmanHeightStage stage_{test::usualRig(), {}};
  Eigen::Vector3d normal_ = normalFromPitchRoll(-4 * kDegree, 0);
  double stamp_ = 1, height_ = 12, pending_ = 0;
};

double stddevOf(const LandingResult& result) { return std::sqrt(result.approach_angle_variance); }

// 20 m/s, and matches that are one period of 2 m too far.
TEST(KalmanHeightAngle, IsAsUncertainAsItChangesByAStepOfAPeriodTooLongWhileTheHeightIsValid) {
  Flight flight;
  LandingResult result;
  for (int i = 0; i < 40; ++i) {
    result = flight.fly(1, 0.01);
    EXPECT_EQ(failedTests(result.tests), "") << i;
  }
  ASSERT_TRUE(result.angle_valid) << result.failure.message();
  EXPECT_NEAR(stddevOf(result), kStddev, 0.02 * kStddev);
  EXPECT_NEAR(result.speed(), 20, 0.1);
  const double off = std::atan2(0.01, 1) - std::atan2(0.01, 3);
  for (int i = 0; i < 20; ++i) {
    result = flight.fly(3, 0.01);
    EXPECT_EQ(failedTests(result.tests), "velocity") << i;
    EXPECT_NEAR(stddevOf(result), std::hypot(off, kStddev), 0.02 * off) << i;
    EXPECT_NEAR(std::sqrt(result.raw_approach_angle_variance), std::hypot(off, kStddev), 0.02 * off) << i;
    EXPECT_TRUE(result.height_valid) << result.failure.message();
    EXPECT_TRUE(result.velocity.array().isNaN().all()) << "three times as fast, " << i;
  }
}

TEST(KalmanHeightAngle, IsNotValidForAsLongAsAStepAsideIsInItsWindow) {
  Flight flight;
  LandingResult result;
  for (int i = 0; i < 40; ++i) result = flight.fly(1, 0.06);
  ASSERT_TRUE(result.angle_valid) << result.failure.message();
  result = flight.fly(1, 0.06, 2);
  EXPECT_EQ(failedTests(result.tests), "velocity");
  // As far as to the other camera: 1.5 degrees instead of 3.4.
  EXPECT_NEAR(stddevOf(result), std::atan(0.06) - std::atan(0.06 / std::sqrt(5)), 0.1 * kDegree);
  int until = 1;
  while (!(result = flight.fly(1, 0.06)).angle_valid && until < 40) {
    EXPECT_EQ(failedTests(result.tests), "");
    EXPECT_EQ(result.failure.reason, Reason::kUncertain);
    EXPECT_NEAR(std::sqrt(result.raw_approach_angle_variance), kStddev, 0.02 * kStddev) << "the last step";
    ++until;
  }
  EXPECT_NEAR(until * kT, kWindow, 1.01 * kT);
  EXPECT_NEAR(stddevOf(result), kStddev, 0.02 * kStddev);
}

TEST(KalmanHeightAngle, GivesNoVelocityForASecondAfterAStepThatContradicts) {
  Flight flight;
  LandingResult result;
  for (int i = 0; i < 40; ++i) result = flight.fly(1, 0.06);
  ASSERT_NEAR(result.speed(), 20, 0.1);
  ASSERT_EQ(failedTests(flight.fly(1, 0.06, 2).tests), "velocity");
  int until = 1;
  while (std::isnan((result = flight.fly(1, 0.06)).speed()) && until < 40) {
    EXPECT_TRUE(result.height_valid) << result.failure.message();
    EXPECT_TRUE(result.angular_velocity.allFinite());
    ++until;
  }
  EXPECT_NEAR(until * kT, 1, 1.01 * kT);
}

TEST(KalmanHeightAngle, GivesNoVelocityWhereNobodyCanTellWhetherTheStepIsRight) {
  Flight flight;
  LandingResult result;
  for (int i = 0; i < 10; ++i) result = flight.fly(1, 0.06);
  EXPECT_NEAR(result.speed(), 20, 0.1);
  EXPECT_TRUE(result.twist_covariance.allFinite());
  flight.turn = 30 * kDegree * kT;
  EXPECT_TRUE(std::isnan(flight.fly(1, 0.06).speed())) << "an unusual turn";
  flight.turn = 10 * kDegree * kT;
  EXPECT_NEAR(flight.fly(1, 0.06).speed(), 20, 0.1);
  flight.agreement = 0;
  result = flight.fly(1, 0.06);
  ASSERT_EQ(failedTests(result.tests), "row_agreement");
  EXPECT_TRUE(std::isnan(result.speed())) << "a pair that is left out";
  EXPECT_TRUE(result.twist_covariance.array().isNaN().all());
}

TEST(KalmanHeightAngle, AVelocityIsByTheDepthsOfThePlaneAndAsUncertainAsThatChangesIt) {
  const auto fly = [](double misjudged) {
    Flight flight;
    flight.misjudged = misjudged;
    LandingResult result;
    for (int i = 0; i < 10; ++i) result = flight.fly(1, 0.06);
    return result;
  };
  const LandingResult right = fly(0), other = fly(0.2 * kDegree);
  const double change = other.speed() / right.speed() - 1;
  // The depth at an angle e below the horizon is the height over tan e: the middle of the matches is some 20
  // degrees below. The movement's normal leans forward, so its plane rises ahead: its depths are too small.
  EXPECT_GT(change, 0.2 * kDegree / std::tan(25 * kDegree));
  EXPECT_LT(change, 0.2 * kDegree / std::tan(15 * kDegree));
  EXPECT_NEAR(std::sqrt(other.speedVariance() - right.speedVariance()), change * right.speed(),
              0.05 * change * right.speed());
}

TEST(KalmanHeightAngle, CountsTheTimeOfRepeatedPicturesOnce) {
  Flight flight;
  for (int i = 0; i < 40; ++i) flight.fly(1, 0.06);
  flight.fly(1, 0.06, 2);
  int pairs = 0;
  do {
    flight.repeat();
    flight.repeat();
    pairs += 3;
  } while (!flight.fly(3, 0.18).angle_valid && pairs < 40);
  EXPECT_GE(pairs * kT, kWindow - 1e-9);
  EXPECT_LE(pairs * kT, kWindow + 3.01 * kT);
}

TEST(KalmanHeightAngle, AVelocityThatHasChangedUnusuallyIsAsUncertainAsTheChange) {
  const auto varianceAfter = [](double change) {
    Flight flight;
    for (int i = 0; i < 20; ++i) flight.fly(1, 0.06);
    const LandingResult result = flight.fly(1 + change * kT, 0.06);
    EXPECT_EQ(failedTests(result.tests), "") << change;
    return result.speedVariance();
  };
  // 5 m/s^2 are 0.25 m/s from pair to pair, 1 sigma: two are usual, four are not yet a contradiction.
  const double usual = varianceAfter(0);
  EXPECT_NEAR(varianceAfter(0.5) / usual, 1, 0.1);
  EXPECT_NEAR(std::sqrt(varianceAfter(1) - usual), 1, 0.05);
}

}  // namespace
}  // namespace uav_landing
