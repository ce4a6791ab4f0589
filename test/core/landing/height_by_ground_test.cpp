#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "landing/height/height_measurement.h"
#include "support/degree.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::angleAt;
using test::groundOf;
using test::kDegree;
using test::pairOf;
using test::stereoAt;
using test::usualRig;

constexpr double kHeight = 10;

MeasuredHeight heightOf(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                        const Ground& ground, const KalmanHeightParameters& parameters = {}) {
  return heightByGround(usualRig(), parameters, pairOf(stereo, approach), ground);
}

MeasuredHeight heightOf(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                        const KalmanHeightParameters& parameters = {}) {
  return heightOf(stereo, approach, groundOf(stereo.plane), parameters);
}

/// On level ground this far below a level camera, or on something.
StereoDepthResult::Point pointAt(double forward, double below, bool on_plane = true) {
  return {320, 240 + 500 * below / forward, 500 / forward, 0.1, on_plane};
}

/// Matches of the ground below a level camera.
StereoDepthResult levelPair(const std::vector<double>& forwards) {
  StereoDepthResult stereo = stereoAt(0, kHeight, 0, 0);
  for (const double forward : forwards) stereo.points.push_back(pointAt(forward, kHeight));
  return stereo;
}

KalmanHeightParameters byPoints(ReconstructionAngle angle = ReconstructionAngle::kPitch) {
  KalmanHeightParameters parameters;
  parameters.height_source = HeightSource::kPoints;
  parameters.reconstruction_angle = angle;
  return parameters;
}

TEST(HeightByGround, IsThatOfThePlaneWithTheModelErrorInTheVariance) {
  KalmanHeightParameters parameters;
  parameters.height_model_error = 0.002;
  const MeasuredHeight measured = heightOf(stereoAt(0, kHeight, -0.1, 0.05, 0.01), angleAt(0), parameters);
  EXPECT_FALSE(measured.failure);
  EXPECT_NEAR(measured.height, kHeight, 1e-9);
  EXPECT_NEAR(measured.variance, 0.01 * 0.01 + 0.02 * 0.02, 1e-9);
}

TEST(HeightByGround, IsAboveTheSurfaceBelowAndHasWhatItsShapeLeavesOpen) {
  const StereoDepthResult stereo = stereoAt(0, kHeight, -0.1, 0.05, 0.01);
  Ground ground = groundOf(stereo.plane);
  ground.surface.below.g *= kHeight / 10.5;
  ground.surface.bend_variance = 0.03 * 0.03;
  ground.surface.unevenness = 0.04 * 0.04;
  KalmanHeightParameters parameters;
  parameters.height_model_error = 0;
  const MeasuredHeight measured = heightOf(stereo, angleAt(0), ground, parameters);
  EXPECT_NEAR(measured.height, 10.5, 1e-9);
  EXPECT_NEAR(measured.variance, 0.01 * 0.01 + 0.03 * 0.03 + 0.04 * 0.04, 1e-9);
}

TEST(HeightByGround, WhatThePairsHaveInCommonIsByItsCause) {
  HeightErrors errors;
  errors.relative = 0.002;
  errors.surface = 1;
  errors.bend = 2;
  errors.averaging = 4;
  errors.rig = 8;
  errors.width = 16;
  EXPECT_NEAR(errors.modelVariance(kHeight), 0.02 * 0.02 + 1 + 2 + 4, 1e-12);
  const CommonVariance common = errors.common(kHeight);
  EXPECT_NEAR(common.lasting, 0.02 * 0.02 + 1 + 4 + 8, 1e-12);
  EXPECT_EQ(common.bend, 2);
  EXPECT_EQ(common.width, 16);
}

TEST(HeightByGround, TheRigsErrorIsInThePlanesVarianceAlready) {
  const StereoDepthResult stereo = stereoAt(0, kHeight);
  Ground ground = groundOf(stereo.plane);
  const double before = heightOf(stereo, angleAt(0), ground).variance;
  ground.rig_variance = 0.5;
  const MeasuredHeight measured = heightOf(stereo, angleAt(0), ground);
  EXPECT_EQ(measured.variance, before);
  EXPECT_EQ(measured.errors.rig, 0.5);
}

TEST(HeightByGround, SaysWhyThereIsNone) {
  Ground ground;
  ground.failure = {Reason::kTooFewMatches, "7 of at least 20"};
  const MeasuredHeight measured = heightOf(test::noStereo(0), angleAt(0), ground);
  EXPECT_EQ(measured.failure.message(), "too_few_matches: 7 of at least 20");
  EXPECT_TRUE(std::isnan(measured.height));
}

TEST(HeightByGround, AveragesThePointsOfALevelledCameraOnRequest) {
  const double alpha = 0.1;
  StereoDepthResult stereo = stereoAt(0, kHeight, -alpha, 0);
  for (const double forward : {40.0, 60.0, 90.0}) {
    const double depth = forward * std::cos(alpha) + kHeight * std::sin(alpha);
    stereo.points.push_back(pointAt(depth, kHeight * std::cos(alpha) - forward * std::sin(alpha)));
  }
  const MeasuredHeight measured = heightOf(stereo, angleAt(0), byPoints());
  EXPECT_NEAR(measured.height, kHeight, 1e-9);
  EXPECT_NEAR(measured.points_height, kHeight, 1e-9);
  EXPECT_NEAR(heightOf(stereo, angleAt(0)).points_height, kHeight, 1e-9) << "reported for the plane, too";

  // To the letter: 5 degrees of approach angle in place of 0.1 rad of pitch.
  const double mean_forward = (40.0 + 60.0 + 90.0) / 3, turn = 5 * kDegree - alpha;
  EXPECT_NEAR(heightOf(stereo, angleAt(0), byPoints(ReconstructionAngle::kApproach)).height,
              kHeight * std::cos(turn) + mean_forward * std::sin(turn), 1e-9);
}

TEST(HeightByGround, AveragesThePointsOnThePlaneOrEveryDepthAsThePaperDoes) {
  StereoDepthResult stereo = levelPair({40, 60, 90});
  stereo.points.push_back(pointAt(50, kHeight - 2, false));
  EXPECT_NEAR(heightOf(stereo, angleAt(0), byPoints()).height, kHeight, 1e-9);
  const double forward = (40.0 + 60.0 + 90.0 + 50.0) / 4, below = kHeight - 2.0 / 4;
  EXPECT_NEAR(heightOf(stereo, angleAt(0), byPoints(ReconstructionAngle::kApproach)).height,
              below * std::cos(5 * kDegree) + forward * std::sin(5 * kDegree), 1e-9);
}

// The angle is known to 0.1 degrees, the points are 60 m ahead on average. All of them are on the plane.
TEST(HeightByGround, AnAverageIsAsUncertainAsTheAngleTurnsItsDepth) {
  KalmanHeightParameters parameters = byPoints(ReconstructionAngle::kApproach);
  parameters.height_model_error = 0;
  const StereoDepthResult stereo = levelPair({50, 60, 70});
  ApproachAngleResult level = angleAt(0);
  level.window.angle = 0;
  const double by_angle = heightOf(stereo, level, parameters).variance;
  level.window.angle_variance = 1e-15;
  const double without = heightOf(stereo, level, parameters).variance;
  EXPECT_NEAR(by_angle - without, std::pow(60 * 0.1 * kDegree, 2), 1e-9);
}

// The depths of all points are too large by a share, as those of far ones are on average.
TEST(HeightByGround, WhatMakesTheAverageAnotherThanThePlanesIsItsError) {
  constexpr double kShare = 0.02;
  StereoDepthResult stereo = levelPair({40, 60, 90});
  for (StereoDepthResult::Point& point : stereo.points) point.disparity /= 1 + kShare;
  const MeasuredHeight measured = heightOf(stereo, angleAt(0), byPoints());
  EXPECT_NEAR(measured.height, (1 + kShare) * kHeight, 1e-9);
  EXPECT_NEAR(std::sqrt(measured.errors.averaging), kShare * kHeight, 1e-9);
  EXPECT_GE(measured.variance, measured.errors.averaging);
}

TEST(HeightByGround, ASinglePointIsNoAverage) {
  EXPECT_EQ(heightOf(levelPair({40}), angleAt(0), byPoints()).failure.message(),
            "too_few_matches: 1 of at least 2 points to average");
}

TEST(HeightByGround, NamesWhyThereIsNoAngleToTheLetter) {
  const StereoDepthResult stereo = levelPair({40, 60});
  const KalmanHeightParameters parameters = byPoints(ReconstructionAngle::kApproach);
  ApproachAngleResult approach = angleAt(0);
  approach.step = approach.window = {};
  EXPECT_EQ(heightOf(stereo, approach, parameters).failure.message(),
            "no_motion: no approach angle to reconstruct the height with");
  approach.step.failure = {Reason::kMotionInconsistent, "3 of 300 matches agree"};
  EXPECT_EQ(heightOf(stereo, approach, parameters).failure.message(),
            "motion_inconsistent: 3 of 300 matches agree");
  approach.failure = {Reason::kNoMotion, "standing still"};
  EXPECT_EQ(heightOf(stereo, approach, parameters).failure.message(), "no_motion: standing still");
}

// To the letter a steep climb turns points 60 m ahead to above the camera.
TEST(HeightByGround, AHeightThatIsNotAboveTheGroundIsNone) {
  ApproachAngleResult approach = angleAt(0);
  approach.window.angle = -0.5;
  EXPECT_EQ(heightOf(levelPair({50, 70}), approach, byPoints(ReconstructionAngle::kApproach)).failure.reason,
            Reason::kNoPlane);
}

}  // namespace
}  // namespace uav_landing
