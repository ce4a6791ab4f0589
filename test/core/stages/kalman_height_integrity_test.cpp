#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "integrity/test_catalogue.h"
#include "support/ground_matches.h"
#include "support/rigs.h"
#include "uav_landing/rig/rig_rotation.h"
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
  KalmanHeightStage stage(test::usualRig(), {}, {40});
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

TEST(KalmanHeightIntegrity, WhatAllPointsHaveInCommonIsInTheHeightsWithoutARegion) {
  // Of a rig that is not watched: what its rows may be wrong by is the same without any region.
  KalmanHeightParameters parameters;
  parameters.rig_watch = false;
  const auto varianceOfRegions = [&](double row_stddev) {
    KalmanHeightStage stage(test::usualRig(), parameters);
    LandingResult result;
    for (int i = 0; i < 5; ++i) {
      StereoDepthResult stereo = stereoAt(1 + 0.05 * i, 10);
      stereo.row_covariance(1, 1) = row_stddev * row_stddev;
      stereo.plane.covariance += stereo.row_covariance;
      result = stage.process(stereo, levelFlight(1 + 0.05 * i, 10));
    }
    return result.tests[static_cast<int>(IntegrityTest::kImageRegions)].variance;
  };
  // dh = -h^2 n.dg, and g is wrong along y.
  const double by_rows = std::pow(10 * 10 * std::cos(4 * kDegree) * 1e-3, 2);
  EXPECT_NEAR(varianceOfRegions(1e-3) - varianceOfRegions(0), by_rows, 0.01 * by_rows);
}

TEST(KalmanHeightIntegrity, HeightsThatScatterMoreThanTheyClaimHaveAVarianceThatSaysSo) {
  KalmanHeightParameters parameters;
  const auto fly = [&](double scatter) {
    KalmanHeightStage stage(test::usualRig(), parameters);
    std::mt19937 random(5);
    std::normal_distribution<double> error(0, scatter);
    LandingResult result;
    for (int i = 0; i < 60; ++i) {
      const double stamp = 1 + 0.05 * i;
      StereoDepthResult stereo = stereoAt(stamp, 10 + error(random));
      stereo.points.clear();
      stereo.plane.covariance *= 36;  // claims a stddev of 0.06 / n.z of the height
      result = stage.process(stereo, levelFlight(stamp, 10));
    }
    return result;
  };
  const double claimed = std::sqrt(fly(0).raw_height_variance);
  const LandingResult honest = fly(0.8 * claimed), bold = fly(2.5 * claimed);
  EXPECT_GT(bold.height_variance, 1.5 * honest.height_variance);
  EXPECT_NEAR(bold.vertical_speed_variance, honest.vertical_speed_variance,
              0.1 * honest.vertical_speed_variance)
      << "by the motion";
  parameters.use_motion = false;
  EXPECT_GT(fly(2.5 * claimed).vertical_speed_variance, 1.5 * fly(0.8 * claimed).vertical_speed_variance);
}

TEST(KalmanHeightIntegrity, MotionsThatScatterMoreThanTheyClaimHaveASpeedThatSaysSo) {
  const auto fly = [](double scatter) {
    KalmanHeightStage stage(test::usualRig(), {});
    std::mt19937 random(6);
    std::normal_distribution<double> error(0, scatter);
    LandingResult result;
    for (int i = 0; i < 60; ++i) {
      const double stamp = 1 + 0.05 * i;
      StereoDepthResult stereo = stereoAt(stamp, 10);
      stereo.points.clear();
      stereo.plane.covariance *= 36;
      ApproachAngleResult approach = levelFlight(stamp, 10);
      approach.step.covariance = std::pow(0.002, 2) * Matrix6d::Identity();  // of 10 m in 0.05 s: 0.4 m/s
      approach.step.translation_over_height += error(random) * stereo.plane.normal();
      result = stage.process(stereo, approach);
    }
    return result.vertical_speed_variance;
  };
  EXPECT_NEAR(fly(0.5 * 0.002), fly(0), 1e-6);
  EXPECT_GT(fly(3 * 0.002), 1.25 * fly(0));
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

// The camera nods by 0.1 deg from pair to pair, and planes are off by 0.05 deg this way and that: pairs of
// which every one is shown twice say of the attitude what they say once.
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

TEST(KalmanHeightIntegrity, APictureOnceMoreCountsOnceForTheAttitude) {
  KalmanHeightStage once(test::usualRig(), {}), twice(test::usualRig(), {});
  constexpr double kNod = 0.1 * kDegree, kError = 0.05 * kDegree, kPeriod = 0.1;
  for (int i = 0; i < 40; ++i) {
    const double stamp = 1 + kPeriod * i, error = i % 3 == 0 ? kError : -0.5 * kError;
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.plane.g = normalFromPitchRoll(-4 * kDegree + kNod * i + error, 0) / 10;
    stereo.points = test::matchesOn(test::usualRig(), stereo.plane.g);
    ApproachAngleResult approach = levelFlight(stamp, 10);
    approach.n = stereo.plane.normal();
    for (ApproachAngleResult::Motion* motion : {&approach.step, &approach.window}) {
      motion->duration = kPeriod;
      motion->rotation = Eigen::Vector3d(-kNod, 0, 0);
      motion->translation_over_height *= 2;
    }
    const LandingResult expected = once.process(stereo, approach), shown = twice.process(stereo, approach);
    EXPECT_NEAR(shown.pitch, expected.pitch, 1e-9) << i;
    EXPECT_NEAR(shown.pitch_variance, expected.pitch_variance, 1e-6 * expected.pitch_variance) << i;

    StereoDepthResult again = stereo;
    again.stamp = approach.stamp = stamp + 0.5 * kPeriod;
    again.left_repeated = again.right_repeated = true;
    approach.step = {};
    approach.step.failure = {Reason::kNoMotion, ""};
    const LandingResult repeated = twice.process(again, approach);
    for (const TestResult& test : repeated.tests)
      EXPECT_FALSE(test.name == toString(IntegrityTest::kTilt) && test.possible()) << i;
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
        stereo.plane.g += planeByRotation(rig, stereo.points, stereo.plane.g) * stereo.vertical_rotation.w;
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

TEST(KalmanHeightIntegrity, MatchesThatDoNotHoldAcrossTheRowsGiveNoMeasurement) {
  KalmanHeightStage stage(test::usualRig(), {});
  const auto process = [&](double stamp, double agreement) {
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.row_agreement = agreement;
    return stage.process(stereo, levelFlight(stamp, 10));
  };
  double stamp = 1;
  for (int i = 0; i < 40; ++i, stamp += 0.05) EXPECT_EQ(failedTests(process(stamp, 0.6).tests), "");
  const LandingResult result = process(stamp, 0.4);
  EXPECT_EQ(failedTests(result.tests), "row_agreement");
  EXPECT_EQ(result.failure.message(), "inconsistent: row_agreement");
  EXPECT_TRUE(result.rejected);
  EXPECT_EQ(result.status, Status::kCoasting);
}

TEST(KalmanHeightIntegrity, ABaselineInAnotherDirectionThanCalibratedGivesNoMeasurement) {
  KalmanHeightStage stage(test::usualRig(), {});
  const auto process = [&](double stamp, double forward, double stddev) {
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.baseline_direction.t = {0, forward};
    stereo.baseline_direction.covariance = stddev * stddev * Eigen::Matrix2d::Identity();
    return stage.process(stereo, levelFlight(stamp, 10));
  };
  double stamp = 1;
  for (int i = 0; i < 40; ++i, stamp += 0.05) EXPECT_EQ(failedTests(process(stamp, 0.02, 0.01).tests), "");
  // 4.8 sigma of two numbers are exceeded once in a hundred thousand; a calibration is not perfect either.
  EXPECT_EQ(failedTests(process(stamp, 0.048, 0.01).tests), "");
  const LandingResult result = process(stamp + 0.05, 0.06, 0.01);
  EXPECT_EQ(failedTests(result.tests), "baseline_direction");
  EXPECT_EQ(result.failure.message(), "inconsistent: baseline_direction");
  EXPECT_TRUE(result.rejected);
  EXPECT_EQ(result.status, Status::kCoasting);
}

TEST(KalmanHeightIntegrity, ABaselineThatTheSkewOfThePairExplainsIsNoFault) {
  constexpr double kSkew = 0.005;  // s
  for (const bool step_known : {true, false}) {
    for (const double share : {1.0, 0.0, -1.0}) {
      KalmanHeightStage stage(test::usualRig(), {});
      LandingResult result;
      for (int i = 0; i < 20; ++i) {
        StereoDepthResult stereo = stereoAt(1 + 0.05 * i, 10);
        ApproachAngleResult approach = levelFlight(1 + 0.05 * i, 10);
        const Eigen::Vector3d velocity = 10 / 0.05 * approach.step.translation_over_height;
        stereo.skew = kSkew;
        stereo.baseline_direction.t = share * kSkew / test::usualRig().baseline * velocity.tail<2>();
        stereo.baseline_direction.covariance = 1e-6 * Eigen::Matrix2d::Identity();
        if (!step_known) approach.step = ApproachAngleResult::Motion();
        result = stage.process(stereo, approach);
      }
      // 10 cm of way on a metre of baseline are 6 deg. Where nobody knows the way it may be any.
      const bool passes = !step_known || share == 1;
      EXPECT_EQ(failedTests(result.tests), passes ? "" : "baseline_direction") << step_known << share;
    }
  }
}

TEST(KalmanHeightIntegrity, AsManyPairsInARowMustPassAsFailedBefore) {
  for (const int failures : {1, 2, 3, 5}) {
    KalmanHeightStage stage(test::usualRig(), {});
    double stamp = 1;
    const auto accepted = [&](double agreement) {
      StereoDepthResult stereo = stereoAt(stamp, 10);
      stereo.row_agreement = agreement;
      const LandingResult result = stage.process(stereo, levelFlight(stamp, 10));
      stamp += 0.05;
      return result.status == Status::kTracking;
    };
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(accepted(0.9));
    for (int i = 0; i < failures; ++i) EXPECT_FALSE(accepted(0.4));
    // One that passes by chance, and a failure again: it begins anew.
    if (failures > 1) {
      EXPECT_FALSE(accepted(0.9)) << failures;
      EXPECT_FALSE(accepted(0.4)) << failures;
    }
    const int needed = failures == 1 ? 1 : 3;
    for (int i = 1; i < needed; ++i) EXPECT_FALSE(accepted(0.9)) << failures << ", " << i;
    EXPECT_TRUE(accepted(0.9)) << failures;
    EXPECT_TRUE(accepted(0.9)) << failures;
  }
}

TEST(KalmanHeightIntegrity, AHeightThatContradictionsTookAwayIsBelievedAfterASecondWithoutAny) {
  for (const double recovery_time : {1.0, 0.0}) {
    KalmanHeightParameters parameters;
    parameters.recovery_time = recovery_time;
    KalmanHeightStage stage(test::usualRig(), parameters);
    double stamp = 1;
    int angles = 0;
    const auto valid = [&](double agreement) {
      StereoDepthResult stereo = stereoAt(stamp, 10);
      stereo.row_agreement = agreement;
      const LandingResult result = stage.process(stereo, levelFlight(stamp, 10));
      stamp += 0.05;
      angles += result.angle_valid;
      return result.height_valid;
    };
    for (int i = 0; i < 20; ++i) valid(0.9);
    // A short burst does not take the height away.
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(valid(0.4));
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(valid(0.9));
    for (int i = 0; i < 10; ++i) valid(0.4);
    // The fault goes on: in between pairs pass by chance.
    int believed = angles = 0;
    for (int burst = 0; burst < 4; ++burst) {
      for (int i = 0; i < 10; ++i) believed += valid(0.9);
      for (int i = 0; i < 10; ++i) believed += valid(0.4);
    }
    if (recovery_time > 0)
      EXPECT_EQ(believed + angles, 0);
    else
      EXPECT_GT(std::min(believed, angles), 0);
    // Of the pairs that pass the first two are still left out, but are part of the second without a
    // contradiction: the 20th healthy pair, 0.95 s after the first, has a height again.
    int until = 1;
    while (!valid(0.9) && until < 60) ++until;
    EXPECT_EQ(until, recovery_time > 0 ? 20 : 3);
  }
}

TEST(KalmanHeightIntegrity, AHeightThatContradictionsTookAwayWaitsForTheVanishingPointToAgree) {
  KalmanHeightStage stage(test::usualRig(), {});
  double stamp = 1;
  const auto valid = [&](double agreement, double off) {
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.row_agreement = agreement;
    ApproachAngleResult approach = levelFlight(stamp, 10);
    approach.vanishing_direction = {0, -std::sin(4 * kDegree + off), std::cos(4 * kDegree + off)};
    approach.vanishing_covariance = 1e-6 * Eigen::Matrix3d::Identity();
    const LandingResult result = stage.process(stereo, approach);
    EXPECT_EQ(result.tests[static_cast<int>(IntegrityTest::kVanishingPoint)].failed(), off > 0);
    stamp += 0.05;
    return result.height_valid;
  };
  for (int i = 0; i < 20; ++i) valid(0.9, 0);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(valid(0.9, i < 10 ? 2 * kDegree : 0)) << "alone it is left out";
  for (int i = 0; i < 10; ++i) valid(0.4, 0);
  for (int i = 0; i < 30; ++i) EXPECT_FALSE(valid(0.9, 2 * kDegree)) << i;
  int until = 1;
  while (!valid(0.9, 0) && until < 60) ++until;
  EXPECT_EQ(until, 20);
}

TEST(KalmanHeightIntegrity, AnImuThatContradictsTheGroundsNormalIsNamedAndOneThatAgreesIsNot) {
  // The ground's slope is in the imu's covariance: 0.6 degrees, 1 sigma. The limit of 1e-5 with two degrees
  // of freedom is 4.8 sigma: 2.9 degrees.
  for (const double off_deg : {0.0, 2.0, -2.0, 4.0, -4.0}) {
    KalmanHeightStage stage(test::usualRig(), {});
    LandingResult result;
    for (int i = 0; i < 5; ++i) {
      const double stamp = 1 + 0.05 * i;
      ApproachAngleResult approach = levelFlight(stamp, 10);
      approach.imu.normal = normalFromPitchRoll((-4 + off_deg) * kDegree, 0);
      approach.imu.normal_covariance = std::pow(0.6 * kDegree, 2) * Eigen::Matrix3d::Identity();
      result = stage.process(stereoAt(stamp, 10), approach);
    }
    EXPECT_EQ(failedTests(result.tests), std::abs(off_deg) > 3 ? "imu" : "") << off_deg;
    const TestResult& test = result.tests[static_cast<int>(IntegrityTest::kImu)];
    EXPECT_NEAR(test.difference, std::abs(off_deg) * kDegree, 0.002) << off_deg;
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
