#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/degree.h"
#include "support/kalman_height_inputs.h"
#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

using test::angleAt;
using test::kDegree;
using test::kStep;
using test::noStereo;
using test::settle;
using test::stereoAt;
using test::usualRig;
using test::withoutTurning;

TEST(KalmanHeightReconstruction, ReportsTheMeasurementAndKeepsTheModelErrorInTheVariance) {
  KalmanHeightParameters parameters;
  parameters.height_model_error = 0.002;
  parameters.acceleration_stddev = 0.01;
  KalmanHeightStage stage(usualRig(), parameters);
  double stamp = settle(stage, 10, 300);
  const LandingResult result = stage.process(stereoAt(stamp, 10, -0.1, 0.05, 0.01), angleAt(stamp));
  EXPECT_NEAR(result.raw_height, 10, 1e-9);
  EXPECT_NEAR(result.raw_height_variance, 0.01 * 0.01 + 0.02 * 0.02, 1e-7);
  // However many pairs are averaged, the surface below differs from the plane ahead by 2 cm.
  EXPECT_GT(result.height_variance, 0.02 * 0.02);
  EXPECT_LT(result.height_variance, 1.5 * 0.02 * 0.02);
}

TEST(KalmanHeightReconstruction, DoesNotAverageAwayTheUnevennessOfTheSurface) {
  KalmanHeightParameters parameters;
  parameters.height_model_error = 0;
  parameters.acceleration_stddev = 0.01;
  KalmanHeightStage stage(usualRig(), parameters);
  LandingResult result;
  for (int i = 0; i < 300; ++i) {
    StereoDepthResult stereo = stereoAt(i * kStep, 10);
    stereo.surface_variance = 0.03 * 0.03;
    result = stage.process(stereo, angleAt(i * kStep));
  }
  EXPECT_GT(result.height_variance, 0.03 * 0.03);
  EXPECT_LT(result.height_variance, 1.5 * 0.03 * 0.03);
}

TEST(KalmanHeightReconstruction, AJumpOfTheClockForgetsHowEvenTheSurfaceWas) {
  const auto rough = [](KalmanHeightStage& stage, double stamp) {
    StereoDepthResult stereo = stereoAt(stamp, 20);
    stereo.surface_variance = 0.2 * 0.2;
    return stage.process(stereo, angleAt(stamp));
  };
  KalmanHeightStage fresh(usualRig(), {}), jumps(usualRig(), {});
  for (int i = 0; i < 30; ++i) {
    StereoDepthResult stereo = stereoAt(500 + i * kStep, 20);
    stereo.surface_variance = 0;
    jumps.process(stereo, angleAt(500 + i * kStep));
  }
  for (int i = 0; i < 5; ++i) {
    const LandingResult expected = rough(fresh, i * kStep), result = rough(jumps, i * kStep);
    EXPECT_EQ(result.raw_height_variance, expected.raw_height_variance) << i;
    EXPECT_EQ(result.height_variance, expected.height_variance) << i;
  }
}

TEST(KalmanHeightReconstruction, DoesNotAverageAwayTheBiasOfARigThatIsNotWatched) {
  constexpr double kHeight = 30, kBias = 0.1;  // m, px
  const StereoRig rig = usualRig();
  KalmanHeightParameters parameters;
  parameters.rig_watch = false;
  parameters.height_model_error = 0;
  parameters.acceleration_stddev = 0.1;
  KalmanHeightStage stage(rig, parameters);
  LandingResult result;
  for (int i = 0; i < 100; ++i) {
    StereoDepthResult stereo = stereoAt(i * kStep, kHeight, -0.25);
    stereo.disparity_bias_stddev = kBias;
    stereo.plane.covariance(2, 2) += std::pow(kBias / rig.fb(), 2);
    result = stage.process(stereo, angleAt(i * kStep));
  }
  // d height = -height^2 n.dg, and the bias is an error of g along the optical axis of bias / fb.
  EXPECT_GT(std::sqrt(result.height_variance), 0.99 * kHeight * kHeight * std::sin(0.25) * kBias / rig.fb());
}

TEST(KalmanHeightReconstruction, IsHardlyLessCertainByASinglePairThatLeavesTheBendOpen) {
  KalmanHeightStage stage(usualRig(), {});
  LandingResult before, result;
  for (int i = 0; i <= 60; ++i) {
    StereoDepthResult stereo = stereoAt(i * kStep, 10);
    stereo.below = stereo.plane;
    // The height is 1 / g_y here, which is 0.1: 1 cm, and in the last pair 8 cm.
    stereo.below.covariance(1, 1) += std::pow(1e-4 * (i < 60 ? 1 : 8), 2);
    before = result;
    result = stage.process(stereo, angleAt(i * kStep));
  }
  EXPECT_GT(result.raw_height_variance, 0.07 * 0.07);
  EXPECT_GT(before.height_variance, 0.01 * 0.01);
  EXPECT_LT(result.height_variance, 0.25 * result.raw_height_variance);
  EXPECT_TRUE(result.height_valid);
}

TEST(KalmanHeightReconstruction, ClaimsWhatAKnownWidthIsWrongByInEveryPair) {
  // A chart's width is wrong by 0.2 % (1 sigma), in all pairs of a flight alike. Each run is another runway.
  constexpr double kHeight = 20, kWidth = 40;
  constexpr int kRuns = 300, kPairs = 40;
  KalmanHeightParameters parameters;
  parameters.height_model_error = 0;
  parameters.acceleration_stddev = 0.05;
  RigParameters exact;
  exact.baseline_stddev = 0;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double ratio = 0, share_of_width = 0;
  for (int run = 0; run < kRuns; ++run) {
    KalmanHeightStage stage(usualRig(), parameters, {kWidth, 0, 1e-6}, exact);
    const double width = kWidth * (1 + 0.002 * normal(random));
    LandingResult result;
    for (int i = 0; i < kPairs; ++i) {
      ApproachAngleResult approach = angleAt(i * kStep);
      approach.runway.y = 0;
      approach.runway.y_variance = 1e-6;
      approach.runway.width = width / kHeight + 1e-4 * normal(random);
      approach.runway.width_variance = 1e-8;
      result =
          stage.process(stereoAt(i * kStep, kHeight + 0.02 * normal(random), -0.1, 0.05, 0.02), approach);
    }
    // Without the width it would be 0.02^2.
    ASSERT_NEAR(result.raw_height_variance, 1 / (1 / std::pow(0.02, 2) + 1 / std::pow(0.04, 2)), 1e-6);
    ratio += std::pow(result.height - kHeight, 2) / result.height_variance / kRuns;
    // Stereo has 0.02 m, the width 0.04 m: a fifth of the width's error is in each pair.
    share_of_width += std::pow(0.2 * 0.002 * kHeight, 2) / result.height_variance / kRuns;
  }
  EXPECT_GT(share_of_width, 0.5) << "the variance is of something else";
  EXPECT_GT(ratio, 0.75);
  EXPECT_LT(ratio, 1.25);
}

// The depths of all points are too large by a share, as those of far ones are on average.
TEST(KalmanHeightReconstruction, DoesNotAverageAwayWhatMakesTheAverageAnotherThanThePlanes) {
  constexpr double kHeight = 10, kShare = 0.02;
  KalmanHeightParameters parameters;
  parameters.height_source = HeightSource::kPoints;
  parameters.height_model_error = 0;
  KalmanHeightStage stage(usualRig(), parameters);
  LandingResult result;
  for (int i = 0; i < 100; ++i) {
    StereoDepthResult stereo = stereoAt(i * kStep, kHeight, 0, 0);
    for (const double depth : {40.0, 60.0, 90.0}) {
      StereoDepthResult::Point point;
      point.u = 320;
      point.v = 240 + 500 * kHeight / depth;
      point.disparity = 500 * 1.0 / depth / (1 + kShare);
      point.disparity_stddev = 0.1;
      point.on_plane = true;
      stereo.points.push_back(point);
    }
    result = stage.process(stereo, angleAt(i * kStep));
  }
  EXPECT_NEAR(result.height, (1 + kShare) * kHeight, 1e-3);
  EXPECT_NEAR(std::sqrt(result.height_variance), kShare * kHeight, 0.1 * kShare * kHeight);
}

/// Of a runway 45 m wide from this height.
ApproachAngleResult runwayFrom(double stamp, double height) {
  ApproachAngleResult approach = angleAt(stamp);
  approach.runway.y = 0;
  approach.runway.y_variance = 1e-6;
  approach.runway.width = 45 / height;
  approach.runway.width_variance = std::pow(0.001 * approach.runway.width, 2);
  return approach;
}

TEST(KalmanHeightReconstruction, CarriesOnByTheRunwaysWidthWithoutStereo) {
  for (const bool fuse : {true, false}) {
    KalmanHeightParameters parameters;
    parameters.fuse_width_height = fuse;
    KalmanHeightStage stage(usualRig(), parameters);
    double stamp = 0;
    for (int i = 0; i < 20; ++i, stamp += kStep) stage.process(stereoAt(stamp, 20), runwayFrom(stamp, 20));
    LandingResult result;
    for (int i = 1; i <= 20; ++i, stamp += kStep)
      result = stage.process(noStereo(stamp), runwayFrom(stamp, 20 - 0.1 * i));
    EXPECT_NEAR(result.width_height, 18, 0.02);
    EXPECT_EQ(result.height_valid, fuse);
    if (!fuse) continue;
    EXPECT_EQ(result.status, Status::kTracking);
    EXPECT_NEAR(result.height, 18, 0.1);
    // The learned width is no better than the heights that it was learned from.
    EXPECT_GE(std::sqrt(result.height_variance), 0.9 * 0.01);
  }
}

TEST(KalmanHeightReconstruction, TheWidthTellsTheHeightAboveWhatIsBelowWhereTheSurfaceBends) {
  // The plane ahead is 20 m below, the surface straight below 20.5 m.
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  LandingResult before, result;
  for (int i = 0; i < 20; ++i, stamp += kStep) {
    StereoDepthResult stereo = stereoAt(stamp, 20);
    stereo.below = stereo.plane;
    stereo.below.g *= 20 / 20.5;
    before = stage.process(stereo, runwayFrom(stamp, 20));
  }
  EXPECT_NEAR(before.height, 20.5, 0.01);
  for (int i = 0; i < 5; ++i, stamp += kStep) {
    result = stage.process(noStereo(stamp), runwayFrom(stamp, 20));
    EXPECT_NEAR(result.raw_height, 20.5, 0.02) << i;
  }
  EXPECT_TRUE(result.height_valid) << result.failure.message();
  EXPECT_EQ(result.status, Status::kTracking);
  EXPECT_GT(result.raw_height_variance, std::pow(0.2, 2)) << "half a second on the bend may be another";
}

TEST(KalmanHeightReconstruction, TheWidthSeenOnAPlaneRefusedForItsTiltIsNoHeight) {
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  const auto runway = [&] {
    ApproachAngleResult approach = withoutTurning(stamp);
    approach.runway = runwayFrom(stamp, 20).runway;
    const Eigen::Vector3d n = stereoAt(stamp, 20).plane.normal();
    approach.step.translation_over_height = 0.1 * (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
    return approach;
  };
  LandingResult before;
  for (int i = 0; i < 20; ++i, stamp += kStep) before = stage.process(stereoAt(stamp, 20), runway());
  ASSERT_TRUE(before.height_valid) << before.failure.message();
  const LandingResult tilted = stage.process(stereoAt(stamp, 20, -0.1, 0.05 + 6 * kDegree), runway());
  EXPECT_EQ(tilted.status, Status::kCoasting);
  EXPECT_TRUE(tilted.rejected);
  EXPECT_EQ(tilted.consecutive_rejections, 1);
  EXPECT_NEAR(tilted.raw_height, 20, 1e-9) << "of the plane that was refused";
  // A speed by the tilted plane would be of metres a second, as the flight is 2 m a pair.
  EXPECT_NEAR(tilted.vertical_speed, before.vertical_speed, 0.05);
}

TEST(KalmanHeightReconstruction, HeightsThatAreRefusedDoNotTeachTheWidth) {
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  for (int i = 0; i < 20; ++i, stamp += kStep) stage.process(stereoAt(stamp, 20), runwayFrom(stamp, 20));
  LandingResult result;
  for (int i = 0; i < 6; ++i, stamp += kStep) {
    result = stage.process(stereoAt(stamp, 16), runwayFrom(stamp, 20));
    ASSERT_TRUE(result.rejected) << i;
  }
  result = stage.process(noStereo(stamp), runwayFrom(stamp, 20));
  EXPECT_NEAR(result.width_height, 20, 0.02);
}

TEST(KalmanHeightReconstruction, DoesNotAverageAwayWhatAKnownWidthIsWrongBy) {
  KalmanHeightParameters parameters;
  parameters.height_model_error = 0;
  parameters.acceleration_stddev = 0.1;
  KalmanHeightStage stage(usualRig(), parameters, {45, 0, 1e-6});
  LandingResult result;
  for (int i = 0; i < 100; ++i)
    result = stage.process(stereoAt(i * kStep, 20, -0.1, 0.05, 0.3), runwayFrom(i * kStep, 20));
  // 0.2 % of the width.
  EXPECT_GT(std::sqrt(result.height_variance), 0.95 * 0.002 * 20);
}

}  // namespace
}  // namespace uav_landing
