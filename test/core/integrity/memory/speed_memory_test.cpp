#include "integrity/memory/speed_memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kStddev = 0.01;  // m, of a step

/// Shortfall over its stddev; not a number where there is no test. Learns what agrees.
double fly(SpeedMemory& memory, double duration, double way) {
  const CameraStep step{duration, way, kStddev * kStddev};
  const auto shortfall = memory.compare(step);
  const double ratio = shortfall ? shortfall->difference / std::sqrt(shortfall->variance) : kUnknown;
  memory.learn(step, !(ratio > 4.4));
  return ratio;
}

TEST(SpeedMemory, APictureThatStandsStillContradictsTheSpeedForAsLongAsItDoes) {
  SpeedMemory memory(3);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(fly(memory, 0.05, 1)));
  EXPECT_LT(fly(memory, 0.05, 1), 0);
  // 20 m/s less 3 m/s^2 for 0.05 s; three tenths of it for 0.05 s are enough.
  const auto shortfall = memory.compare({0.05, 0, kStddev * kStddev});
  EXPECT_NEAR(shortfall->difference, 0.3 * 0.05 * (20 - 0.15), 1e-9);
  EXPECT_GT(std::sqrt(shortfall->variance), kStddev);
  for (double time = 0; time < 20; time += 0.05) EXPECT_GT(fly(memory, 0.05, 0), 4.4);
  EXPECT_LT(fly(memory, 0.05, 1), 0) << "it moves on";
}

TEST(SpeedMemory, TwoStepsThatAreTooLongAreNotTheSpeed) {
  SpeedMemory memory(3);
  for (int i = 0; i < 5; ++i) fly(memory, 0.05, 1);
  for (int i = 0; i < 2; ++i) EXPECT_LT(fly(memory, 0.05, 18), 0);
  for (int i = 0; i < 5; ++i) EXPECT_LT(fly(memory, 0.05, 1), 0) << i;
  EXPECT_GT(fly(memory, 0.05, 0), 4.4);
}

TEST(SpeedMemory, AnAircraftThatBrakesMayStop) {
  SpeedMemory memory(3);
  double speed = 20;
  for (int i = 0; i < 200; ++i, speed = std::max(0.0, speed - 2.9 * 0.05))
    EXPECT_FALSE(fly(memory, 0.05, speed * 0.05) > 4.4) << speed;
  EXPECT_EQ(speed, 0);
}

TEST(SpeedMemory, StampsThatAreLateAreNotAStandstill) {
  SpeedMemory memory(3);
  double late = 0;
  for (int i = 0; i < 200; ++i) {
    const double next = 0.02 * (1 + std::sin(1.9 * i));
    EXPECT_FALSE(fly(memory, 0.05 + next - late, 1) > 4.4) << i;
    late = next;
  }
}

TEST(SpeedMemory, APairWithoutMotionDoesNotMakeAStandstillBelievable) {
  SpeedMemory memory(3);
  for (int i = 0; i < 5; ++i) fly(memory, 0.1, 1);
  EXPECT_GT(fly(memory, 0.1, 0), 4.4);
  for (int i = 0; i < 50; ++i) memory.skip(0.1);
  EXPECT_GT(fly(memory, 0.1, 0), 4.4);
  EXPECT_LT(fly(memory, 0.1, 1), 0);
}

TEST(SpeedMemory, NoiseThatSeemsToMoveNowAndThenIsNotMotion) {
  SpeedMemory memory(3);
  for (int i = 0; i < 5; ++i) fly(memory, 0.1, 1);
  for (int i = 0; i < 3; ++i) EXPECT_GT(fly(memory, 0.1, 0), 4.4);
  // Of 0.3 (10 - 0.3) m/s for 0.1 s, 0.29 m: hardly short, then long enough, then still again.
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(fly(memory, 0.1, 0.27) > 4.4);
    EXPECT_FALSE(fly(memory, 0.1, 0.3) > 4.4);
    EXPECT_TRUE(memory.stands());
    EXPECT_GT(fly(memory, 0.1, 0), 4.4);
  }
  for (int i = 0; i < 10; ++i) fly(memory, 0.1, 0.27);
  EXPECT_TRUE(memory.stands()) << "no step is long enough";
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(memory.stands());
    fly(memory, 0.1, 1);
  }
  EXPECT_FALSE(memory.stands());
}

TEST(SpeedMemory, ShortStepsThatAreUncertainDoNotMakeShorterOnesBelievable) {
  SpeedMemory memory(3);
  for (int i = 0; i < 5; ++i) fly(memory, 0.05, 1);
  // Of 0.3 (20 - 0.15) m/s for 0.05 s, 0.3 m: no contradiction, as uncertain as it is, and no speed either.
  for (const double way : {0.2, 0.1, 0.05}) memory.learn({0.05, way, 0.1 * 0.1}, true);
  EXPECT_GT(fly(memory, 0.05, 0), 4.4);
  EXPECT_NEAR(memory.compare({0.05, 0, 0})->difference, 0.3 * 0.05 * (20 - 4 * 0.15), 1e-9);
}

TEST(SpeedMemory, NothingIsSaidWhereItMayHaveStoppedUnseen) {
  SpeedMemory memory(3);
  for (int i = 0; i < 5; ++i) fly(memory, 0.1, 0.1);
  memory.skip(0.3);
  EXPECT_TRUE(std::isnan(fly(memory, 0.1, 0))) << "1 m/s within 0.4 s";
}

TEST(SpeedMemory, AGapBeforeKnownStepsExcusesNoStandstillAfterThem) {
  SpeedMemory memory(3);
  for (int i = 0; i < 5; ++i) fly(memory, 0.1, 1);
  // 10 m/s may be lost in 3.4 s, but three steps have shown since that it was not.
  memory.skip(5);
  for (int i = 0; i < 3; ++i) fly(memory, 0.1, 1);
  EXPECT_GT(fly(memory, 0.1, 0), 4.4);
}

TEST(SpeedMemory, APictureThatStandsStillForHalfAMinuteIsThatOfAnAircraftThatStands) {
  SpeedMemory memory(3);
  for (int i = 0; i < 5; ++i) fly(memory, 0.125, 2.5);
  for (int i = 0; i < 240; ++i) EXPECT_GT(fly(memory, 0.125, 0), 4.4) << i;
  EXPECT_TRUE(memory.stands());
  for (int i = 0; i < 4; ++i) fly(memory, 0.125, 0);
  EXPECT_FALSE(memory.stands());
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(fly(memory, 0.125, 0) > 4.4) << i;
}

TEST(SpeedMemory, ForgetsAtAReset) {
  SpeedMemory memory(3);
  for (int i = 0; i < 5; ++i) fly(memory, 0.05, 1);
  fly(memory, 0.05, 0);
  ASSERT_TRUE(memory.stands());
  memory.reset();
  EXPECT_FALSE(memory.stands());
  EXPECT_TRUE(std::isnan(fly(memory, 0.05, 0))) << "of a speed that was, nothing is known";
}

TEST(SpeedMemory, AShortfallIsAsUncertainAsTheWayAndTheSlowestSpeed) {
  SpeedMemory memory(3);
  for (int i = 0; i < 3; ++i) memory.learn({0.05, 1, 0.1 * 0.1}, true);  // 20 m/s to 2 m/s
  const auto shortfall = memory.compare({0.1, 0.5, 0.03 * 0.03});
  ASSERT_TRUE(shortfall);
  EXPECT_NEAR(shortfall->difference, 0.3 * 0.1 * (20 - 0.3) - 0.5, 1e-9);
  EXPECT_NEAR(std::sqrt(shortfall->variance), std::hypot(0.3 * 0.1 * 2, 0.03), 1e-9);
}

StereoRig makeRig() { return test::rigOf({640, 480}, 500, {320, 240}, 320, 1.0); }

/// A pair of a flight of 20 m/s at 10 m, or of one whose picture stands still.
LandingResult flyPair(KalmanHeightStage& stage, double stamp, bool still) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  stereo.plane.g = normalFromPitchRoll(-4 * kDegree, 0) / 10;
  stereo.plane.covariance = 1e-8 * Eigen::Matrix3d::Identity();
  ApproachAngleResult approach;
  approach.stamp = stamp;
  approach.n = normalFromPitchRoll(-4 * kDegree, 0);
  approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
  ApproachAngleResult::Motion& step = approach.step;
  step.duration = 0.05;
  step.rotation.setZero();
  const Eigen::Vector3d forward(0, -std::sin(4 * kDegree), std::cos(4 * kDegree));
  step.translation_over_height = (still ? 0.001 : 0.1) * forward;
  step.covariance = 1e-6 * Matrix6d::Identity();
  step.angle = 0;
  step.angle_variance = 1e-6;
  if (still) step.failure = {Reason::kNoMotion, "the movement is not larger than its own uncertainty"};
  return stage.process(stereo, approach);
}

TEST(KalmanHeightStandstill, AHangingCameraIsNoticedInTimeAndNotBelievedLater) {
  KalmanHeightStage stage(makeRig(), {});
  double stamp = 1;
  for (; stamp < 3; stamp += 0.05) EXPECT_EQ(failedTests(flyPair(stage, stamp, false).tests), "");
  const double onset = stamp;
  for (; stamp < onset + 6; stamp += 0.05) {
    const LandingResult result = flyPair(stage, stamp, true);
    EXPECT_EQ(failedTests(result.tests), "standstill");
    EXPECT_EQ(result.failure.message(), "inconsistent: standstill");
    EXPECT_FALSE(result.height_valid && stamp > onset + 0.35) << stamp - onset;
  }
  LandingResult result;
  const double healthy = stamp;
  for (; stamp < healthy + 0.99; stamp += 0.05) result = flyPair(stage, stamp, false);
  EXPECT_TRUE(result.height_valid) << result.failure.message();
}

TEST(KalmanHeightStandstill, ACameraThatStandsFromTheBeginningIsBelieved) {
  KalmanHeightStage stage(makeRig(), {});
  LandingResult result;
  for (double stamp = 1; stamp < 3; stamp += 0.05) {
    result = flyPair(stage, stamp, true);
    EXPECT_EQ(failedTests(result.tests), "");
  }
  EXPECT_TRUE(result.height_valid) << result.failure.message();
}

}  // namespace
}  // namespace uav_landing
