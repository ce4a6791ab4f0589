#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "integrity/tests/test_catalogue.h"
#include "rig/rig_rotation.h"
#include "support/ground_matches.h"
#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// A pair of a level flight at this height, 20 m/s, with its points.
StereoDepthResult stereoAt(double stamp, double height) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  stereo.plane.g = normalFromPitchRoll(-4 * kDegree, 0) / height;
  const double along = 0.01 / (height * height);
  stereo.plane.covariance = along * along * Eigen::Matrix3d::Identity();
  stereo.points = test::matchesOn(test::usualRig(), stereo.plane.g);
  return stereo;
}

ApproachAngleResult levelFlight(double stamp, double height) {
  ApproachAngleResult approach;
  approach.stamp = stamp;
  approach.n = normalFromPitchRoll(-4 * kDegree, 0);
  approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d forward(0, -std::sin(4 * kDegree), std::cos(4 * kDegree));
  for (ApproachAngleResult::Motion* motion : {&approach.step, &approach.window}) {
    motion->duration = 0.05;
    motion->rotation.setZero();
    motion->translation_over_height = forward / height;
    motion->covariance = 1e-8 * Matrix6d::Identity();
    motion->angle = 0;
    motion->angle_variance = 1e-6;
  }
  return approach;
}

TEST(KalmanHeightIntegrity, AHealthyFlightPassesAllTestsAndIsProtected) {
  KalmanHeightStage stage(test::usualRig(), {});
  LandingResult result;
  for (int i = 0; i < 40; ++i)
    result = stage.process(stereoAt(1 + 0.05 * i, 10), levelFlight(1 + 0.05 * i, 10));
  EXPECT_TRUE(result.height_valid) << result.failure.message();
  EXPECT_EQ(failedTests(result.tests), "");
  EXPECT_TRUE(result.tests[static_cast<int>(IntegrityTest::kSinkRate)].possible());
  EXPECT_TRUE(result.tests[static_cast<int>(IntegrityTest::kImageRegions)].possible());
  EXPECT_GT(result.height_protection_level, 0.2) << "two per cent of 10 m are by assumption";
  EXPECT_LT(result.height_protection_level, 0.5);
  EXPECT_DOUBLE_EQ(result.height_alert_limit, 0.05 * result.height);
}

/// x after pairs that are refused, of which the outline says that the runway is 3 m nearer.
double xAfterRefusedPairs(bool outline_by_stereo) {
  KalmanHeightStage stage(test::usualRig(), {});
  LandingResult result;
  for (int i = 0; i < 45; ++i) {
    const double stamp = 1 + 0.05 * i, height = i < 40 ? 10 : 13;
    ApproachAngleResult approach = levelFlight(stamp, 10);
    ApproachAngleResult::Sight& sight = approach.sight;
    sight.position = {-400 + i + (i < 40 ? 0 : 3), 0, 10};
    sight.covariance = Eigen::Vector3d(9, 0.25, 0.04).asDiagonal();
    sight.height_by_chart = 1;
    if (outline_by_stereo) {
      sight.disparity = 1;
      sight.disparity_variance = 1e-4;
    }
    result = stage.process(stereoAt(stamp, height), approach);
    EXPECT_EQ(result.rejected, i >= 40) << i << ' ' << result.failure.message();
  }
  return result.x;
}

TEST(KalmanHeightIntegrity, ARefusedPairDoesNotTellWhereTheRunwayIsByStereo) {
  EXPECT_NEAR(xAfterRefusedPairs(true), -356, 0.5);
  EXPECT_GT(xAfterRefusedPairs(false), -355) << "an outline by the chart alone does not rest on stereo";
}

TEST(KalmanHeightIntegrity, ARepeatedImageGivesNoMeasurementAndTheAlertComesInTime) {
  KalmanHeightStage stage(test::usualRig(), {});
  double stamp = 1;
  for (int i = 0; i < 40; ++i, stamp += 0.05) stage.process(stereoAt(stamp, 10), levelFlight(stamp, 10));
  const double onset = stamp;
  LandingResult result;
  do {
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.left_repeated = true;
    result = stage.process(stereo, levelFlight(stamp, 10));
    EXPECT_EQ(result.status, Status::kCoasting);
    EXPECT_TRUE(result.rejected);
    EXPECT_EQ(failedTests(result.tests), "repeated_image");
    EXPECT_EQ(result.failure.message(), "inconsistent: repeated_image");
    stamp += 0.05;
  } while (result.height_valid && stamp < onset + 2);
  EXPECT_LE(stamp - 0.05 - onset, 0.35 + 1e-9);
  EXPECT_EQ(result.consecutive_rejections, result.tests[0].consecutive_failures);
}

TEST(KalmanHeightIntegrity, APairThatFailsItsTestsGivesNoAngleEither) {
  KalmanHeightStage stage(test::usualRig(), {});
  double stamp = 1;
  LandingResult result;
  const auto fly = [&](bool left_repeated, bool right_repeated) {
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.left_repeated = left_repeated;
    stereo.right_repeated = right_repeated;
    result = stage.process(stereo, levelFlight(stamp, 10));
    stamp += 0.05;
  };
  for (int i = 0; i < 40; ++i) fly(false, false);
  ASSERT_TRUE(result.angle_valid) << result.failure.message();
  fly(true, false);
  EXPECT_TRUE(result.angle_valid) << "that of the pair before, as approach_angle gives it";
  for (int i = 0; i < 10; ++i) fly(false, false);
  ASSERT_TRUE(result.angle_valid) << result.failure.message();
  fly(false, true);
  EXPECT_FALSE(result.angle_valid) << "by a plane of an old right image";
}

TEST(KalmanHeightIntegrity, AWrongKnownWidthIsWithinTheProtectionLevel) {
  KalmanHeightStage stage(test::usualRig(), {}, {40, 0, 1e-6});
  LandingResult result;
  for (int i = 0; i < 80; ++i) {
    const double stamp = 1 + 0.05 * i;
    StereoDepthResult stereo = stereoAt(stamp, 20);
    stereo.plane.covariance *= 900;  // 1 sigma of 0.3 m
    stereo.points.clear();           // what regions say is not asked here
    ApproachAngleResult approach = levelFlight(stamp, 20);
    approach.runway.failure = {};
    approach.runway.y = 0;
    approach.runway.y_variance = 1e-4;
    approach.runway.width = 41.6 / 20;
    approach.runway.width_variance = 1e-6;
    result = stage.process(stereo, approach);
  }
  ASSERT_GT(std::abs(result.height - 20), 0.4) << "the width is not used";
  EXPECT_GT(result.height_protection_level, std::abs(result.height - 20));
}

TEST(KalmanHeightIntegrity, EverySecondPictureRepeatedLeavesTheHeightOfADescentAvailable) {
  KalmanHeightStage stage(test::usualRig(), {});
  const auto height = [](double stamp) { return 20 - 1.5 * (stamp - 1); };
  LandingResult result;
  for (int i = 0; i < 80; ++i) {
    const double stamp = 1 + 0.05 * i;
    const bool started = i > 30, repeated = started && i % 2 == 0;
    const double h = height(repeated ? stamp - 0.05 : stamp);
    StereoDepthResult stereo = stereoAt(stamp, h);
    stereo.left_repeated = stereo.right_repeated = repeated;
    ApproachAngleResult approach = levelFlight(stamp, h);
    const double duration = started && i > 31 ? 0.1 : 0.05;
    approach.step.duration = duration;
    approach.step.translation_over_height =
        duration / h * (20 * approach.step.translation_over_height.normalized() + 1.5 * approach.n);
    if (repeated) {
      approach.step = {};
      approach.step.failure = {Reason::kNoMotion, ""};
    }
    result = stage.process(stereo, approach);
    if (i < 15) continue;
    EXPECT_TRUE(result.height_valid) << i << ": " << result.failure.message();
    EXPECT_NEAR(result.height, height(stamp), 0.05) << i;
    EXPECT_NEAR(result.vertical_speed, -1.5, 0.1) << i;
    EXPECT_EQ(failedTests(result.tests), repeated ? "repeated_image" : "") << i;
  }
}

TEST(KalmanHeightIntegrity, TheGroundBelowIsAsMuchNearerAsTheHeightWhilePicturesRepeat) {
  KalmanHeightStage stage(test::usualRig(), {});
  const auto height = [](int i) { return 12 - 0.1 * i; };
  LandingResult before, result;
  for (int i = 0; i < 63; ++i) {
    const bool repeated = i >= 60;
    const double stamp = 1 + 0.05 * i, h = height(repeated ? 59 : i);
    StereoDepthResult stereo = stereoAt(stamp, h);
    stereo.left_repeated = stereo.right_repeated = repeated;
    ApproachAngleResult approach = levelFlight(stamp, h);
    approach.step.translation_over_height =
        (approach.step.translation_over_height.normalized() + 0.1 * approach.n) / h;
    if (repeated) {
      approach.step = {};
      approach.step.failure = {Reason::kNoMotion, ""};
    } else {
      before = result;
    }
    result = stage.process(stereo, approach);
    if (!repeated) continue;
    EXPECT_NEAR(result.height, height(i), 0.05);
    EXPECT_NE(result.protection_source, "surface_below");
    EXPECT_LT(result.height_protection_level, before.height_protection_level + 0.1);
  }
}

// What a minute has taught of the rig must not speak against what it is since.
TEST(KalmanHeightIntegrity, AHeightIsRightAlsoAfterABendLateInALongFlight) {
  const StereoRig rig = test::usualRig();
  for (const double roll : {0.05, 0.2, -0.2}) {
    SCOPED_TRACE(roll);
    constexpr double kHeight = 20, kBent = 60;
    KalmanHeightStage stage(rig, {});
    int valid_afterwards = 0;
    for (double stamp = 0; stamp < kBent + 15; stamp += 0.05) {
      StereoDepthResult stereo = stereoAt(stamp, kHeight);
      stereo.disparity_bias_stddev = 0.1;
      stereo.plane.covariance(2, 2) += std::pow(0.1 / rig.fb(), 2);
      stereo.vertical_rotation.w.setZero();
      stereo.vertical_rotation.covariance = std::pow(0.005 * kDegree, 2) * Eigen::Matrix3d::Identity();
      if (stamp > kBent) {
        stereo.vertical_rotation.w.z() = roll * kDegree;
        stereo.plane.g +=
            planeByRotation(rig, stereo.points, PlaneVector(stereo.plane.g)) * stereo.vertical_rotation.w;
        stereo.points = test::matchesOn(rig, stereo.plane.g);
      }
      const LandingResult result = stage.process(stereo, levelFlight(stamp, kHeight));
      if (!result.height_valid) continue;
      ASSERT_LT(std::abs(result.height - kHeight), result.height_protection_level) << stamp;
      valid_afterwards += stamp > kBent + 1;
    }
    EXPECT_GT(valid_afterwards, 40);
  }
}

TEST(KalmanHeightIntegrity, AHeightThatContradictionsTookAwayIsBelievedAfterASecondWithoutAny) {
  for (const double recovery_time : {1.0, 0.0}) {
    KalmanHeightParameters parameters;
    parameters.recovery_time = recovery_time;
    KalmanHeightStage stage(test::usualRig(), parameters);
    double stamp = 1;
    int angles = 0, velocities = 0;
    const auto valid = [&](double agreement) {
      StereoDepthResult stereo = stereoAt(stamp, 10);
      stereo.row_agreement = agreement;
      const LandingResult result = stage.process(stereo, levelFlight(stamp, 10));
      stamp += 0.05;
      angles += result.angle_valid;
      velocities += result.velocity.allFinite();
      return result.height_valid;
    };
    for (int i = 0; i < 20; ++i) valid(0.9);
    EXPECT_GT(velocities, 10);
    // A short burst does not take the height away.
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(valid(0.4));
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(valid(0.9));
    for (int i = 0; i < 10; ++i) valid(0.4);
    // The fault goes on: in between pairs pass by chance.
    int believed = angles = velocities = 0;
    for (int burst = 0; burst < 4; ++burst) {
      for (int i = 0; i < 10; ++i) believed += valid(0.9);
      for (int i = 0; i < 10; ++i) believed += valid(0.4);
    }
    if (recovery_time > 0)
      EXPECT_EQ(believed + angles + velocities, 0);
    else
      EXPECT_GT(std::min({believed, angles, velocities}), 0);
    // Of the pairs that pass the first two are still left out, but are part of the second without a
    // contradiction: the 20th healthy pair, 0.95 s after the first, has a height again.
    int until = 1;
    while (!valid(0.9) && until < 60) ++until;
    EXPECT_EQ(until, recovery_time > 0 ? 20 : 3);
  }
}

TEST(KalmanHeightIntegrity, AnotherHeightAfterALossOfTrackIsNotBelievedWhileTheOldOneIsRemembered) {
  KalmanHeightStage stage(test::usualRig(), {});
  double stamp = 1;
  for (int i = 0; i < 40; ++i, stamp += 0.05) stage.process(stereoAt(stamp, 10), levelFlight(stamp, 10));
  const double onset = stamp;
  LandingResult result;
  for (; stamp < onset + 3; stamp += 0.05) {
    result = stage.process(stereoAt(stamp, 14), levelFlight(stamp, 10));
    EXPECT_FALSE(result.height_valid && std::abs(result.height - 14) < 1);
  }
  EXPECT_GT(result.resets, 0);
  EXPECT_NEAR(result.height, 14, 0.1);
  EXPECT_EQ(failedTests(result.tests), "sink_rate");
}

}  // namespace
}  // namespace uav_landing
