#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "support/rigs.h"
#include "uav_landing/consistency_tests.h"
#include "uav_landing/height_memory.h"
#include "uav_landing/innovation_scatter.h"
#include "uav_landing/kalman_height_stage.h"
#include "uav_landing/recovery.h"
#include "uav_landing/region_planes.h"
#include "uav_landing/solution_separation.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

StereoRig makeRig() { return test::rigOf({640, 480}, 500, {320, 240}, 320, 1.0); }

/// Matches on a grid over the ground of this plane.
std::vector<StereoDepthResult::Point> matchesOn(const StereoRig& rig, const Eigen::Vector3d& g) {
  std::vector<StereoDepthResult::Point> points;
  for (int v = 300; v < 470; v += 12) {
    for (int u = 20; u < 620; u += 25) {
      const double error = 0.05 * std::sin(1.7 * u + 2.9 * v);
      points.push_back({double(u), double(v), rig.fb() * g.dot(rig.ray(u, v)) + error, 0.05, true});
    }
  }
  return points;
}

SolutionSeparation::Measurements same(double height, double variance) {
  SolutionSeparation::Measurements all;
  all.fill({height, variance, 0});
  return all;
}

TEST(ConsistencyTests, LimitsAreThoseOfTheChiSquareTable) {
  EXPECT_NEAR(chiSquareLimit(0.05, 1), 3.841, 1e-3);
  EXPECT_NEAR(chiSquareLimit(0.001, 2), 13.816, 1e-3);
  EXPECT_NEAR(normalQuantile(0.05), 1.960, 1e-3);
  EXPECT_NEAR(normalQuantile(1e-5), 4.417, 1e-3);
}

TEST(ConsistencyTests, CountsFailuresInARowAndForgetsThemAtTheNextPairThatPasses) {
  ConsistencyTests tests(0.05);
  for (const double difference : {3.0, 3.0, 1.0}) {
    tests.begin();
    tests.add(Consistency::kRunwayWidth, difference, 1.0);
    const std::vector<TestResult> results = tests.finish();
    const TestResult& width = results[static_cast<int>(Consistency::kRunwayWidth)];
    EXPECT_EQ(width.name, "runway_width");
    EXPECT_EQ(width.failed(), difference > 1.96);
    EXPECT_FALSE(results[static_cast<int>(Consistency::kTilt)].possible());
    if (difference < 2) {
      EXPECT_EQ(width.consecutive_failures, 0);
      EXPECT_EQ(failedTests(results), "");
    } else {
      EXPECT_EQ(failedTests(results), "runway_width");
    }
  }
}

TEST(SolutionSeparation, BoundsTheErrorByTheSolutionWithoutTheSourceThatIsWrong) {
  KalmanHeightParameters parameters;
  parameters.integrity_risk = 1e-5;
  parameters.fault_probability = 1e-3;
  parameters.unwatched_scale_error = 0;
  parameters.use_motion = false;
  SolutionSeparation separation(parameters);
  SolutionSeparation::Measurements without = same(10, 0.01);
  // The left half of the image is wrong by half a metre; only the filter without it knows.
  without[static_cast<int>(FaultySource::kLeft)].height = 9.5;
  separation.start(without, 10);
  const auto level = separation.protectionLevel(10, 0.01);
  EXPECT_STREQ(level.source, "left_region");
  EXPECT_NEAR(level.bound, 0.5 + 2.576 * 0.1, 1e-3);  // 1 % to both sides: 2.576 sigma
  // Pair after pair the noise averages out, the separation stays.
  for (int i = 0; i < 50; ++i) {
    separation.predict(0.05);
    separation.update(without);
  }
  const auto later = separation.protectionLevel(10, 0.001);
  EXPECT_GT(later.bound, 0.5);
  EXPECT_LT(later.bound, level.bound);
}

TEST(SolutionSeparation, IsWiderByTheFactorThatClaimsAreWrongBy) {
  KalmanHeightParameters parameters;
  parameters.unwatched_scale_error = 0;
  SolutionSeparation separation(parameters);
  separation.start(same(10, 0.01), 10);
  // With the default prior of a fault, 1e-3, and risk, 1e-5: 2.576 sigma.
  EXPECT_NEAR(separation.protectionLevel(10, 1e-12).bound, 2.576 * 0.1, 1e-3);
  EXPECT_NEAR(separation.protectionLevel(10, 1e-12, 4).bound, 2.576 * 0.2, 1e-3);
}

TEST(SolutionSeparation, GrowsWhereNothingIsLeftWithoutTheSource) {
  SolutionSeparation separation({});
  separation.start(same(10, 0.0001), 10);
  SolutionSeparation::Measurements without = same(10, 0.0001);
  without[static_cast<int>(FaultySource::kNear)] = {};
  double before = 0;
  for (int i = 0; i < 20; ++i) {
    separation.predict(0.05);
    separation.update(without);
    const auto level = separation.protectionLevel(10, 0.0001);
    if (i > 5) {
      EXPECT_STREQ(level.source, "near_region");
      EXPECT_GT(level.bound, before);
    }
    before = level.bound;
  }
}

TEST(SolutionSeparation, HasTheScaleThatNothingSeesInIt) {
  KalmanHeightParameters parameters;
  parameters.unwatched_scale_error = 0.02;
  SolutionSeparation separation(parameters);
  EXPECT_NEAR(separation.protectionLevel(10, 1e-12).bound, 0.2, 1e-4);
  EXPECT_STREQ(separation.protectionLevel(10, 1e-12).source, "scale");
  EXPECT_STREQ(separation.protectionLevel(10, 1).source, "noise");
  EXPECT_NEAR(separation.protectionLevel(10, 1).bound, 4.417, 1e-3);
}

TEST(RegionPlanes, APlaneWithoutTheWrongHalfIsRight) {
  const StereoRig rig = makeRig();
  const Eigen::Vector3d g = normalFromPitchRoll(-4 * kDegree, 0) / 10;
  std::vector<StereoDepthResult::Point> points = matchesOn(rig, g);
  // Left of the middle all disparities are too large by a share: a height too low by a twentieth.
  for (StereoDepthResult::Point& point : points)
    if (point.u < 310) point.disparity *= 1.02;
  const RegionPlanes planes = planesWithoutRegions(rig, points, g);
  const auto heightWithout = [&](ImageRegion region) {
    return planes.without[static_cast<int>(region)].height();
  };
  EXPECT_NEAR(heightWithout(ImageRegion::kLeft), 10, 0.03);
  EXPECT_NEAR(heightWithout(ImageRegion::kRight), 10 / 1.02, 0.03);
  EXPECT_GT(planes.without[static_cast<int>(ImageRegion::kNear)].heightVariance(),
            planes.all.heightVariance());
}

TEST(RegionPlanes, NothingIsClaimedWithoutPoints) {
  const RegionPlanes planes = planesWithoutRegions(makeRig(), {}, {0, 0.1, 0});
  EXPECT_FALSE(planes.all.valid());
  for (const GroundPlane& plane : planes.without) EXPECT_FALSE(plane.valid());
}

/// A filter that knows height and sink rate.
HeightFilter settled(double height, double speed) {
  HeightFilter filter(1.5, 5, 5);
  filter.initialise(height, 1e-4);
  filter.updateSpeed(speed, 1e-4);
  return filter;
}

TEST(HeightMemory, CarriesTheHeightOnByTheMotion) {
  HeightMemory memory;
  double height = 20;
  for (int i = 0; i <= 24; ++i) {
    if (i > 0) {
      height -= 0.05;
      memory.carry(0.05, -1, 1e-4, 20);
    }
    memory.refresh(settled(height, -1), true, 1);
    if (i == 10) continue;  // the sum of the steps may be a hair less than half a second
    EXPECT_EQ(memory.expected().has_value(), i > 10) << "half a second at 20 Hz, frame " << i;
  }
  EXPECT_NEAR(memory.expected()->height, height, 0.02);
  // 0.15 degrees of half a second to a second at 20 m/s.
  EXPECT_GT(std::sqrt(memory.expected()->variance), 0.026);
  EXPECT_LT(std::sqrt(memory.expected()->variance), 0.1);
}

TEST(HeightMemory, KeepsTheOldHeightWhileTheNewOneContradictsUntilItIsOfNoUse) {
  HeightMemory memory;
  for (int i = 0; i < 25; ++i) {
    memory.carry(0.05, 0, 1e-4, 20);
    memory.refresh(settled(20, 0), true, 1);
  }
  double lasted = 0;
  while (memory.expected() && lasted < 60) {
    EXPECT_NEAR(memory.expected()->height, 20, 0.05);
    memory.carry(0.05, 0, 1e-4, 20);
    memory.refresh(settled(23, 0), false, 1);
    lasted += 0.05;
  }
  // 0.15 degrees at 20 m/s are 5 cm in a second: beyond a metre after about 19 s.
  EXPECT_GT(lasted, 10);
  EXPECT_LT(lasted, 25);
}

RigRotation rotation(double rx_deg, double rz_deg) {
  RigRotation result;
  result.w = Eigen::Vector3d(rx_deg, 0, rz_deg) * kDegree;
  result.covariance = std::pow(0.005 * kDegree, 2) * Eigen::Matrix3d::Identity();
  return result;
}

TEST(RigChange, SeesASuddenBendButNotAConstantError) {
  RigChange change;
  ConsistencyTests tests(1e-5);
  const auto failed = [&](const RigRotation& measured) {
    tests.begin();
    const auto innovation = change.compare(measured);
    if (innovation) tests.add(Consistency::kRigRotation, innovation->difference, innovation->covariance);
    const bool result = tests.failed(Consistency::kRigRotation);
    change.learn(0.05, measured, !result);
    return result;
  };
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(failed(rotation(0.1, -0.05 + 0.003 * std::sin(i))));
  EXPECT_TRUE(failed(rotation(0.1, 0.02)));
  EXPECT_FALSE(failed(rotation(0.1, -0.05)));
}

TEST(RigChange, AnotherRotationIsTheRigsOnceItStaysTheSameForASecond) {
  RigChange change;
  const auto learn = [&](const RigRotation& measured) {
    const auto innovation = change.compare(measured);
    const bool agrees = !innovation || innovation->difference.norm() < 0.03 * kDegree;
    change.learn(0.05, measured, agrees);
  };
  for (int i = 0; i < 40; ++i) learn(rotation(0.1, 0));
  EXPECT_TRUE(change.settled());
  // Images that do not belong together: it changes all the time.
  double settled = 0;
  for (int i = 0; i < 400; ++i) {
    learn(rotation(0.1, 0.2 + 0.01 * (i % 37)));
    if (i > 70) settled += change.settled();
  }
  EXPECT_EQ(settled, 0);
  // A bend: for long it contradicts, then it must stay.
  double waited = 0;
  for (; !change.settled() && waited < 10; waited += 0.05) learn(rotation(0.1, 0.2));
  EXPECT_GE(waited, 1 - 1e-6);
  EXPECT_LT(waited, 2.1);
}

TEST(RigChange, ASmallBendIsTheRigsAfterASecondAndALargeOneAfterFour) {
  const auto secondsUntilKnown = [](double bend_deg) {
    RigChange change;
    const auto learn = [&](const RigRotation& measured) {
      const auto innovation = change.compare(measured);
      const bool agrees = !innovation || innovation->difference.norm() < 0.03 * kDegree;
      change.learn(0.05, measured, agrees);
      return agrees && change.settled();
    };
    for (int i = 0; i < 40; ++i) learn(rotation(0.1, 0));
    double waited = 0;
    while (!learn(rotation(0.1 + bend_deg, 0)) && waited < 10) waited += 0.05;
    return waited;
  };
  EXPECT_NEAR(secondsUntilKnown(0.05), 1, 0.11);
  EXPECT_NEAR(secondsUntilKnown(0.2), 4, 0.11);
  EXPECT_NEAR(secondsUntilKnown(1), 4, 0.11);
}

TEST(RigChange, DoubtsALargeBendUntilItHasStayedForASecond) {
  RigChange change;
  EXPECT_FALSE(change.doubts(rotation(1, 0))) << "nothing is known before";
  for (int i = 0; i < 40; ++i) change.learn(0.05, rotation(0, 0), true);
  EXPECT_FALSE(change.doubts(rotation(0.05, 0)));
  EXPECT_FALSE(change.doubts({})) << "not measured";
  double waited = 0;
  for (; change.doubts(rotation(0, -0.3)) && waited < 10; waited += 0.05)
    change.learn(0.05, rotation(0, -0.3), false);
  EXPECT_NEAR(waited, 1, 0.06);
}

TEST(RigChange, ASmallRotationThatChangesIsNotTheRigs) {
  RigChange change;
  for (int i = 0; i < 40; ++i) change.learn(0.05, rotation(0, 0), true);
  // As of a picture that stands still while the camera moves on slowly.
  for (int i = 0; i < 50; ++i) {
    change.learn(0.05, rotation(0, 0.02 + 0.06 * (i % 2)), false);
    EXPECT_LT(change.compare(rotation(0, 0))->difference.norm(), 0.001 * kDegree) << i;
  }
}

TEST(InnovationScatter, IsThatOfTheClaimsWhereTheyAreTrueAndTellsThoseThatAreNot) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto factorOf = [&](double stddev, InnovationScatter& scatter) {
    double sum = 0;
    for (int i = 0; i < 400; ++i) {
      scatter.add(std::pow(stddev * normal(random), 2));
      sum += scatter.factor();
    }
    return sum / 400;
  };
  InnovationScatter honest(25), timid(25), bold(25);
  EXPECT_LT(factorOf(1, honest), 1.05);
  EXPECT_EQ(factorOf(0.5, timid), 1);
  const double factor = factorOf(2.5, bold);
  EXPECT_GT(factor, 3) << "of 6.25, as far as twenty pairs make it certain";
  EXPECT_LT(factor, 6.25);
}

TEST(InnovationScatter, OneWrongPairSaysNothingOfTheOthers) {
  InnovationScatter scatter(25);
  for (int i = 0; i < 20; ++i) scatter.add(i == 10 ? 1e6 : 0.5);
  EXPECT_LT(scatter.factor(), 1.25);
  scatter.reset();
  EXPECT_EQ(scatter.factor(), 1);
}

TEST(RigChange, APairThatLooksExactByChanceIsNotMoreSoThanThePairsBefore) {
  RigChange change;
  const auto withStddev = [](double rz_deg, double stddev_deg) {
    RigRotation measured = rotation(0, rz_deg);
    measured.covariance = std::pow(stddev_deg * kDegree, 2) * Eigen::Matrix3d::Identity();
    return measured;
  };
  for (int i = 0; i < 40; ++i) change.learn(0.05, withStddev(0, 0.02), true);
  const auto stddev = [&](double of_pair) {
    return std::sqrt(change.compare(withStddev(0.12, of_pair))->covariance(1, 1)) / kDegree;
  };
  // With the floor of 0.004 deg on either side.
  const double before = std::hypot(0.02, 0.004);
  EXPECT_NEAR(stddev(0.001), std::hypot(before, before), 1e-6);
  EXPECT_NEAR(stddev(0.03), std::hypot(before, std::hypot(0.03, 0.004)), 1e-6);
  EXPECT_NEAR(stddev(0.5), std::hypot(before, 2 * before), 1e-6);
}

/// A pair of a level flight at this height, 20 m/s, with its points.
StereoDepthResult stereoAt(double stamp, double height) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  stereo.plane.g = normalFromPitchRoll(-4 * kDegree, 0) / height;
  const double along = 0.01 / (height * height);
  stereo.plane.covariance = along * along * Eigen::Matrix3d::Identity();
  stereo.points = matchesOn(makeRig(), stereo.plane.g);
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
  KalmanHeightStage stage(makeRig(), {});
  LandingResult result;
  for (int i = 0; i < 40; ++i)
    result = stage.process(stereoAt(1 + 0.05 * i, 10), levelFlight(1 + 0.05 * i, 10));
  EXPECT_TRUE(result.height_valid) << result.failure.message();
  EXPECT_EQ(failedTests(result.tests), "");
  EXPECT_TRUE(result.tests[static_cast<int>(Consistency::kSinkRate)].possible());
  EXPECT_TRUE(result.tests[static_cast<int>(Consistency::kImageRegions)].possible());
  EXPECT_GT(result.height_protection_level, 0.2) << "two per cent of 10 m are by assumption";
  EXPECT_LT(result.height_protection_level, 0.5);
  EXPECT_DOUBLE_EQ(result.height_alert_limit, 0.05 * result.height);
}

TEST(KalmanHeightIntegrity, ARepeatedImageGivesNoMeasurementAndTheAlertComesInTime) {
  KalmanHeightStage stage(makeRig(), {});
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

TEST(KalmanHeightIntegrity, HeightsThatScatterMoreThanTheyClaimHaveAVarianceThatSaysSo) {
  const auto fly = [](double scatter) {
    KalmanHeightStage stage(makeRig(), {});
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
}

TEST(KalmanHeightIntegrity, EverySecondPictureRepeatedLeavesTheHeightOfADescentAvailable) {
  KalmanHeightStage stage(makeRig(), {});
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
TEST(KalmanHeightIntegrity, APictureOnceMoreCountsOnceForTheAttitude) {
  KalmanHeightStage once(makeRig(), {}), twice(makeRig(), {});
  constexpr double kNod = 0.1 * kDegree, kError = 0.05 * kDegree, kPeriod = 0.1;
  for (int i = 0; i < 40; ++i) {
    const double stamp = 1 + kPeriod * i, error = i % 3 == 0 ? kError : -0.5 * kError;
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.plane.g = normalFromPitchRoll(-4 * kDegree + kNod * i + error, 0) / 10;
    stereo.points = matchesOn(makeRig(), stereo.plane.g);
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
      EXPECT_FALSE(test.name == toString(Consistency::kTilt) && test.possible()) << i;
  }
}

TEST(KalmanHeightIntegrity, MatchesThatDoNotHoldAcrossTheRowsGiveNoMeasurement) {
  KalmanHeightStage stage(makeRig(), {});
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
  KalmanHeightStage stage(makeRig(), {});
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
      KalmanHeightStage stage(makeRig(), {});
      LandingResult result;
      for (int i = 0; i < 20; ++i) {
        StereoDepthResult stereo = stereoAt(1 + 0.05 * i, 10);
        ApproachAngleResult approach = levelFlight(1 + 0.05 * i, 10);
        const Eigen::Vector3d velocity = 10 / 0.05 * approach.step.translation_over_height;
        stereo.skew = kSkew;
        stereo.baseline_direction.t = share * kSkew / makeRig().baseline * velocity.tail<2>();
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
    KalmanHeightStage stage(makeRig(), {});
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
    KalmanHeightStage stage(makeRig(), parameters);
    double stamp = 1;
    const auto valid = [&](double agreement) {
      StereoDepthResult stereo = stereoAt(stamp, 10);
      stereo.row_agreement = agreement;
      const LandingResult result = stage.process(stereo, levelFlight(stamp, 10));
      stamp += 0.05;
      return result.height_valid;
    };
    for (int i = 0; i < 20; ++i) valid(0.9);
    // A short burst does not take the height away.
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(valid(0.4));
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(valid(0.9));
    for (int i = 0; i < 10; ++i) valid(0.4);
    // The fault goes on: in between pairs pass by chance.
    int believed = 0;
    for (int burst = 0; burst < 4; ++burst) {
      for (int i = 0; i < 10; ++i) believed += valid(0.9);
      for (int i = 0; i < 10; ++i) believed += valid(0.4);
    }
    if (recovery_time > 0)
      EXPECT_EQ(believed, 0);
    else
      EXPECT_GT(believed, 0);
    // Of the pairs that pass the first two are still left out, but are part of the second without a
    // contradiction: the 20th healthy pair, 0.95 s after the first, has a height again.
    int until = 1;
    while (!valid(0.9) && until < 60) ++until;
    EXPECT_EQ(until, recovery_time > 0 ? 20 : 3);
  }
}

TEST(KalmanHeightIntegrity, AHeightThatContradictionsTookAwayWaitsForTheVanishingPointToAgree) {
  KalmanHeightStage stage(makeRig(), {});
  double stamp = 1;
  const auto valid = [&](double agreement, double off) {
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.row_agreement = agreement;
    ApproachAngleResult approach = levelFlight(stamp, 10);
    approach.vanishing_direction = {0, -std::sin(4 * kDegree + off), std::cos(4 * kDegree + off)};
    approach.vanishing_covariance = 1e-6 * Eigen::Matrix3d::Identity();
    const LandingResult result = stage.process(stereo, approach);
    EXPECT_EQ(result.tests[static_cast<int>(Consistency::kVanishingPoint)].failed(), off > 0);
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

TEST(Recovery, NeedsPairsThatAgreeAndNotOnlyTimeWithoutAny) {
  Recovery recovery(1.0);
  recovery.follow(0.1, Recovery::Pair::kContradicts, false);
  EXPECT_FALSE(recovery.pending()) << "the height was not lost";
  recovery.follow(0.1, Recovery::Pair::kContradicts, true);
  for (int i = 0; i < 20; ++i) recovery.follow(0.1, Recovery::Pair::kSilent, false);
  EXPECT_TRUE(recovery.pending());
  for (int i = 0; i < 9; ++i) recovery.follow(0.1, Recovery::Pair::kAgrees, false);
  EXPECT_TRUE(recovery.pending());
  recovery.follow(0.1, Recovery::Pair::kAgrees, false);
  EXPECT_FALSE(recovery.pending());
}

TEST(KalmanHeightIntegrity, AnImuThatContradictsTheGroundsNormalIsNamedAndOneThatAgreesIsNot) {
  // The ground's slope is in the imu's covariance: 0.6 degrees, 1 sigma. The limit of 1e-5 with two degrees
  // of freedom is 4.8 sigma: 2.9 degrees.
  for (const double off_deg : {0.0, 2.0, -2.0, 4.0, -4.0}) {
    KalmanHeightStage stage(makeRig(), {});
    LandingResult result;
    for (int i = 0; i < 5; ++i) {
      const double stamp = 1 + 0.05 * i;
      ApproachAngleResult approach = levelFlight(stamp, 10);
      approach.imu.normal = normalFromPitchRoll((-4 + off_deg) * kDegree, 0);
      approach.imu.normal_covariance = std::pow(0.6 * kDegree, 2) * Eigen::Matrix3d::Identity();
      result = stage.process(stereoAt(stamp, 10), approach);
    }
    EXPECT_EQ(failedTests(result.tests), std::abs(off_deg) > 3 ? "imu" : "") << off_deg;
    const TestResult& test = result.tests[static_cast<int>(Consistency::kImu)];
    EXPECT_NEAR(test.difference, std::abs(off_deg) * kDegree, 0.002) << off_deg;
  }
}

TEST(KalmanHeightIntegrity, AnotherHeightAfterALossOfTrackIsNotBelievedWhileTheOldOneIsRemembered) {
  KalmanHeightStage stage(makeRig(), {});
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
