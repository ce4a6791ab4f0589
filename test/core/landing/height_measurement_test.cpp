#include "landing/height/height_measurement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/degree.h"
#include "support/ground_matches.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::groundOf;
using test::kStep;
using test::measuredHeight;
using test::pairOf;
using test::priorAt;
using test::stereoAt;
using test::usualRig;

constexpr double kHeight = 20, kWidth = 45;  // m

/// Of the runway from this height, its width seen to 0.1 %.
ApproachAngleResult runwayFrom(double height) {
  ApproachAngleResult approach = test::angleAt(0);
  approach.runway.y = 0;
  approach.runway.y_variance = 1e-6;
  approach.runway.width = kWidth / height;
  approach.runway.width_variance = std::pow(0.001 * approach.runway.width, 2);
  return approach;
}

RunwayParameters withKnownWidth(double width = kWidth) { return {width, 0, 1e-12}; }

int indexOf(FaultySource source) { return static_cast<int>(source); }

/// Pairs from the same height, by stereo to 0.2 m, over a runway.
class Pairs {
 public:
  explicit Pairs(const KalmanHeightParameters& parameters = {}) : measurement(usualRig(), parameters) {}
  explicit Pairs(const RunwayParameters& runway, double baseline_stddev = 0)
      : measurement(usualRig(), {}, runway, baseline_stddev) {}

  HeightMeasurement measurement;
  HeightPrior prior = priorAt(kHeight);
  Ground ground = groundOf(stereoAt(0, kHeight, -0.1, 0.05, 0.2).plane);
  double stereo_stddev = 0.2;

  MeasuredHeight see(const ApproachAngleResult& approach, bool accepted = true) {
    return follow(approach, measuredHeight(kHeight, stereo_stddev), accepted);
  }
  MeasuredHeight seeWithoutStereo(const ApproachAngleResult& approach) {
    return follow(approach, test::noHeight(), true);
  }
  /// So many pairs that teach the width, unless their heights are refused.
  void learnWidth(bool accepted = true) {
    for (int i = 0; i < 10; ++i) see(runwayFrom(kHeight), accepted);
  }

 private:
  MeasuredHeight follow(const ApproachAngleResult& approach, const MeasuredHeight& by_ground, bool accepted) {
    const PairInput in = pairOf(approach);
    const MeasuredHeight measured = measurement.propose(in, ground, by_ground, prior);
    measurement.commit(in, ground, measured, accepted);
    return measured;
  }
};

TEST(HeightMeasurement, IsTheHeightByTheGroundWhereNothingElseIsKnown) {
  Pairs pairs;
  const MeasuredHeight measured = pairs.see(test::angleAt(0));
  EXPECT_EQ(measured.height, kHeight);
  EXPECT_NEAR(measured.variance, 0.2 * 0.2, 1e-12);
  EXPECT_EQ(measured.stereo_height, kHeight);
  EXPECT_TRUE(std::isnan(measured.width_height));
  EXPECT_FALSE(measured.by_width);
}

TEST(HeightMeasurement, HasTheDoubtOfTheBaselineBesideItsVariance) {
  Pairs pairs(RunwayParameters(), 0.01);
  const MeasuredHeight measured = pairs.see(test::angleAt(0));
  EXPECT_EQ(measured.errors.baseline, 0.01);
  EXPECT_NEAR(measured.variance, 0.2 * 0.2, 1e-12);
  EXPECT_NEAR(measured.common().baseline, std::pow(0.01 * kHeight, 2), 1e-12);
}

TEST(HeightMeasurement, AKnownWidthKnowsMoreThanABaselineThatIsUncertain) {
  // Stereo to 0.02 m, but for a baseline that is 3 % too long with 1 sigma of 2 %; the width to 0.1 % or so.
  Pairs pairs(withKnownWidth(), 0.02);
  pairs.stereo_stddev = 0.02;
  HeightFilter filter = test::emptyFilter();
  filter.initialise(kHeight, 1e-4, {0, 0, 0, std::pow(0.02 * kHeight, 2)});
  pairs.prior = {filter, HeightTrack::kConfirmations};
  const MeasuredHeight measured = pairs.see(runwayFrom(kHeight / 1.03));
  EXPECT_NEAR(measured.height, kHeight / 1.03, 0.03);
  EXPECT_LT(measured.errors.baseline, 0.1 * 0.02) << "what is left of it";
  EXPECT_LT(std::sqrt(measured.variance + measured.common().baseline), 0.06);
  // Without that doubt the two contradict each other, and stereo stays.
  Pairs sure(withKnownWidth());
  sure.stereo_stddev = 0.02;
  EXPECT_EQ(sure.see(runwayFrom(kHeight / 1.03)).height, kHeight);
}

TEST(HeightMeasurement, CarriesOnByAWidthThatItHasLearned) {
  Pairs pairs;
  pairs.learnWidth();
  const MeasuredHeight measured = pairs.seeWithoutStereo(runwayFrom(kHeight + 0.1));
  EXPECT_TRUE(measured.by_width);
  EXPECT_FALSE(measured.failure);
  EXPECT_NEAR(measured.height, kHeight + 0.1, 1e-6);
  // A learned width is no better than the heights that it was learned from.
  EXPECT_GE(measured.variance, 0.2 * 0.2);
  EXPECT_NEAR(std::sqrt(measured.errors.width), 0.2, 0.01) << "the same on all pairs";
  EXPECT_FALSE(measured.teaches_width);
}

TEST(HeightMeasurement, LearnsTheWidthFromHeightsThatAreAcceptedAndConfirmed) {
  Pairs refused, unconfirmed;
  refused.learnWidth(false);
  EXPECT_TRUE(refused.seeWithoutStereo(runwayFrom(kHeight)).failure);
  unconfirmed.prior.confirmations = 2;
  unconfirmed.learnWidth();
  unconfirmed.prior.confirmations = 3;
  EXPECT_TRUE(unconfirmed.seeWithoutStereo(runwayFrom(kHeight)).failure);
}

TEST(HeightMeasurement, TheWidthIsReportedButNoHeightWhereThatIsNotWanted) {
  KalmanHeightParameters parameters;
  parameters.fuse_width_height = false;
  Pairs pairs(parameters);
  pairs.learnWidth();
  const MeasuredHeight measured = pairs.seeWithoutStereo(runwayFrom(kHeight));
  EXPECT_NEAR(measured.width_height, kHeight, 1e-6);
  EXPECT_TRUE(measured.failure);
}

TEST(HeightMeasurement, OneThatIsNotConfirmedIsNotCarriedOnByTheWidth) {
  Pairs pairs(withKnownWidth());
  pairs.prior.confirmations = 2;
  EXPECT_TRUE(pairs.seeWithoutStereo(runwayFrom(kHeight)).failure);
}

TEST(HeightMeasurement, TheWidthSeenOnAPlaneRefusedForItsTiltIsNoHeight) {
  Pairs pairs;
  pairs.learnWidth();
  pairs.ground.tilted = true;
  EXPECT_FALSE(pairs.see(runwayFrom(kHeight)).by_width);
  EXPECT_FALSE(pairs.see(runwayFrom(kHeight)).teaches_width);
}

TEST(HeightMeasurement, TheWidthTellsTheHeightAboveWhatIsBelowWhereTheSurfaceBends) {
  Pairs pairs(withKnownWidth());
  pairs.ground.surface.bend = 0.5;
  pairs.prior = priorAt(kHeight + 0.5);
  EXPECT_NEAR(pairs.seeWithoutStereo(runwayFrom(kHeight)).height, kHeight + 0.5, 1e-9);
}

TEST(HeightMeasurement, AKnownWidthThatAgreesIsMeantWithStereoAsWeightsSay) {
  Pairs pairs(withKnownWidth());
  const MeasuredHeight measured = pairs.see(runwayFrom(kHeight + 0.1));
  // A chart's width is wrong by 0.2 %, and this one is seen to 0.1 %.
  const double seen = kHeight + 0.1, common = std::pow(0.002 * seen, 2);
  const double by_width = common + std::pow(0.001 * seen, 2), by_stereo = 0.2 * 0.2;
  const double gain = by_stereo / (by_stereo + by_width);
  EXPECT_NEAR(measured.height, kHeight + gain * 0.1, 1e-9);
  EXPECT_NEAR(measured.variance, by_stereo * by_width / (by_stereo + by_width), 1e-9);
  EXPECT_NEAR(measured.errors.width, gain * gain * common, 1e-9) << "does not average out";
  EXPECT_EQ(measured.stereo_height, kHeight) << "as before";
  EXPECT_NEAR(measured.stereo_variance, by_stereo, 1e-12);
}

TEST(HeightMeasurement, WhatTheSurfaceIsWrongByIsNotLessByTheWidth) {
  Pairs pairs(withKnownWidth());
  MeasuredHeight by_ground = measuredHeight(kHeight, 0.2);
  by_ground.errors.surface = 0.3 * 0.3;
  by_ground.variance += by_ground.errors.surface;
  const MeasuredHeight measured =
      pairs.measurement.propose(pairOf(runwayFrom(kHeight)), pairs.ground, by_ground, pairs.prior);
  EXPECT_GT(measured.variance, 0.3 * 0.3);
  EXPECT_LT(measured.variance, 0.3 * 0.3 + 0.05 * 0.05);
}

TEST(HeightMeasurement, AWidthThatContradictsStereoIsReportedAndNotUsed) {
  Pairs pairs(withKnownWidth(30));
  const MeasuredHeight measured = pairs.see(runwayFrom(kHeight));
  EXPECT_NEAR(measured.width_height, kHeight * 30 / kWidth, 1e-6);
  EXPECT_EQ(measured.height, kHeight);
}

// Lines 1.2 m inside of both edges: 5 % narrower, as from 21.1 m.
TEST(HeightMeasurement, EdgesOfAnotherWidthThanTheKnownOneGiveNoHeight) {
  Pairs pairs(withKnownWidth());
  const MeasuredHeight measured = pairs.seeWithoutStereo(runwayFrom(21.1));
  EXPECT_NEAR(measured.width_height, 21.1, 0.01) << "is reported";
  EXPECT_TRUE(measured.failure);
  EXPECT_NEAR(pairs.seeWithoutStereo(runwayFrom(kHeight)).height, kHeight, 0.01) << "the right ones";
}

TEST(HeightMeasurement, EdgesOfAnotherWidthThanTheLearnedOneSayNothing) {
  Pairs pairs;
  pairs.stereo_stddev = 0.02;
  pairs.learnWidth();
  const MeasuredHeight measured = pairs.seeWithoutStereo(runwayFrom(21.1));
  EXPECT_TRUE(std::isnan(measured.width_height));
  EXPECT_TRUE(measured.failure);
}

// Edges 2 % narrower, while stereo of a single pair is good to 1 % only.
TEST(HeightMeasurement, EdgesOfAnotherWidthThanTheKnownOneAreNotMeantWithStereo) {
  EXPECT_EQ(Pairs(withKnownWidth()).see(runwayFrom(20.4)).height, kHeight);
}

TEST(HeightMeasurement, APairWithoutAWidthSaysNothingOfTheEdges) {
  Pairs pairs;
  pairs.learnWidth();
  ApproachAngleResult without = runwayFrom(kHeight);
  without.runway.width = without.runway.width_variance = std::nan("");
  pairs.seeWithoutStereo(without);
  // Off by what is no more than the height's own uncertainty.
  EXPECT_NEAR(pairs.seeWithoutStereo(runwayFrom(20.15)).height, 20.15, 0.01);
}

TEST(HeightMeasurement, KnowsWhetherTheWidthDependsOnStereo) {
  EXPECT_TRUE(Pairs(withKnownWidth()).measurement.widthKnown());
  Pairs learned;
  learned.learnWidth();
  EXPECT_FALSE(learned.measurement.widthKnown());
}

/// Flies 20 m/s with stamps that are off by so much (1 sigma) and returns the mean variance that the height
/// has more than by the ground.
double addedVariance(double jitter, const HeightPrior& prior, bool repeated = false) {
  Pairs pairs;
  std::mt19937 random(2);
  std::normal_distribution<double> error(0, jitter);
  constexpr int kPairs = 1000, kSkipped = 20;
  double sum = 0, before = 0;
  for (int i = 0; i < kPairs; ++i) {
    const double late = error(random);
    StereoDepthResult stereo = test::noStereo(i * kStep + late);
    ApproachAngleResult approach = test::withoutTurning(stereo.stamp);
    approach.step.duration = kStep + late - before;
    approach.step.translation_over_height = {0, 0, 20 * kStep / kHeight};
    approach.step.covariance = 1e-10 * Matrix6d::Identity();
    before = late;
    stereo.left_repeated = repeated && i >= kSkipped;
    const MeasuredHeight measured = pairs.measurement.propose(pairOf(stereo, approach), pairs.ground,
                                                              measuredHeight(kHeight, 0.2), prior);
    if (i >= kSkipped) sum += measured.variance - 0.2 * 0.2;
  }
  return sum / (kPairs - kSkipped);
}

TEST(HeightMeasurement, IsAsUncertainAsItChangesInTheTimeThatTheStampsLeaveOpen) {
  constexpr double kJitter = 0.005;
  const double added = addedVariance(kJitter, priorAt(kHeight, 0.01, -2));
  // What is known of the stamps is of a few pairs: rather too much than too little.
  EXPECT_GT(added, 0.8 * std::pow(2 * kJitter, 2)) << "2 m/s down";
  EXPECT_LT(added, 2 * std::pow(2 * kJitter, 2));
  EXPECT_NEAR(addedVariance(0, priorAt(kHeight, 0.01, -2)), 0, 1e-9) << "right stamps";
  EXPECT_NEAR(addedVariance(kJitter, priorAt(kHeight)), 0, 1e-9) << "a level flight";
  EXPECT_NEAR(addedVariance(kJitter, test::noPrior()), 0, 1e-12) << "a first height";
  EXPECT_NEAR(addedVariance(kJitter, priorAt(kHeight, 0.01, -2), true), 0, 1e-12) << "repeated images";
}

TEST(HeightMeasurement, WithoutTheVanishingPointOrTheMotionItIsThatOfStereoAlone) {
  for (const bool fuse_motion : {false, true}) {
    KalmanHeightParameters parameters;
    parameters.fuse_motion_normal = fuse_motion;
    Pairs pairs(parameters);
    pairs.ground.alone = stereoAt(0, 20.3, -0.1, 0.05, 0.4).plane;
    const MeasuredHeight measured = pairs.see(test::angleAt(0));
    const SolutionSeparation::Measurement &vanishing =
                                              measured.without[indexOf(FaultySource::kVanishingPoint)],
                                          &motion = measured.without[indexOf(FaultySource::kMotion)];
    EXPECT_NEAR(vanishing.height, 20.3, 1e-9);
    EXPECT_NEAR(std::sqrt(vanishing.variance), 0.4, 1e-6);
    EXPECT_NEAR(motion.height, fuse_motion ? 20.3 : kHeight, 1e-9);
    EXPECT_NEAR(std::sqrt(motion.variance), fuse_motion ? 0.4 : 0.2, 1e-6);
  }
}

// The vanishing point and the known width are of the same edges.
TEST(HeightMeasurement, WithoutTheVanishingPointItIsNotByTheWidthEither) {
  Pairs pairs(withKnownWidth());
  const MeasuredHeight measured = pairs.see(runwayFrom(kHeight + 0.1));
  const SolutionSeparation::Measurement& vanishing = measured.without[indexOf(FaultySource::kVanishingPoint)];
  EXPECT_NEAR(vanishing.height, kHeight, 1e-9);
  EXPECT_EQ(vanishing.common.width, 0);
}

// Edges within 2 %, 3 sigma, of the width learned are taken for the same.
TEST(HeightMeasurement, OneByTheWidthAloneMayBeOfOtherEdges) {
  Pairs pairs;
  pairs.learnWidth();
  const MeasuredHeight measured = pairs.seeWithoutStereo(runwayFrom(kHeight));
  ASSERT_TRUE(measured.by_width);
  for (const SolutionSeparation::Measurement& without : measured.without)
    EXPECT_NEAR(without.common.width - measured.errors.width, std::pow(0.02 * kHeight / 3, 2), 1e-9);
}

TEST(HeightMeasurement, AHeightThatIsNotTestedHasNoneWithoutItsSources) {
  KalmanHeightParameters parameters;
  parameters.integrity_monitor = false;
  for (const SolutionSeparation::Measurement& without : Pairs(parameters).see(test::angleAt(0)).without)
    EXPECT_FALSE(without.known());
  for (const SolutionSeparation::Measurement& without : Pairs().seeWithoutStereo(test::angleAt(0)).without)
    EXPECT_FALSE(without.known()) << "nor has one that is none";
}

/// A pair with points that claim 0.05 px. alone_common: what all of them have in common.
MeasuredHeight withPoints(const Eigen::Matrix3d& alone_common, double wrong_far = 0) {
  StereoDepthResult stereo = stereoAt(0, 10);
  stereo.points = test::matchesOn(usualRig(), stereo.plane.g);
  for (StereoDepthResult::Point& point : stereo.points)
    if (point.v < 340) point.disparity += wrong_far;
  Ground ground = groundOf(stereo.plane);
  ground.alone_common = alone_common;
  HeightMeasurement measurement(usualRig(), {});
  return measurement.propose(pairOf(stereo, test::angleAt(0)), ground, measuredHeight(10), priorAt(10));
}

TEST(HeightMeasurement, WithoutARegionWhoseMatchesAreWrongItIsAnother) {
  const MeasuredHeight right = withPoints(Eigen::Matrix3d::Zero());
  const MeasuredHeight wrong = withPoints(Eigen::Matrix3d::Zero(), 0.1);
  const int far = indexOf(FaultySource::kFar);
  EXPECT_NEAR(right.without[far].height, 10, 0.02);
  EXPECT_GT(std::abs(wrong.without[far].height - 10), 0.05);
}

TEST(HeightMeasurement, AVanishingPointThatIsNotFusedIsNotInTheHeightsWithoutARegionEither) {
  StereoDepthResult stereo = stereoAt(0, 10);
  stereo.points = test::matchesOn(usualRig(), stereo.plane.g);
  const Eigen::Vector3d n = stereo.plane.normal();
  ApproachAngleResult seen = test::angleAt(0);
  // A hundredth of a degree off the ground ahead, and known as well as that.
  seen.vanishing_direction =
      ((Eigen::Vector3d::UnitZ() - n.z() * n).normalized() + 0.01 * test::kDegree * n).normalized();
  seen.vanishing_covariance = std::pow(0.01 * test::kDegree, 2) * Eigen::Matrix3d::Identity();
  const auto measure = [&](bool fuse, const ApproachAngleResult& approach) {
    KalmanHeightParameters parameters;
    parameters.fuse_vanishing_point = fuse;
    return HeightMeasurement(usualRig(), parameters)
        .propose(pairOf(stereo, approach), groundOf(stereo.plane), measuredHeight(10), priorAt(10));
  };
  const MeasuredHeight none = measure(false, test::angleAt(0)), ignored = measure(false, seen),
                       fused = measure(true, seen);
  for (int i = indexOf(FaultySource::kNear); i <= indexOf(FaultySource::kRight); ++i) {
    EXPECT_EQ(ignored.without[i].height, none.without[i].height) << i;
    EXPECT_EQ(ignored.without[i].variance, none.without[i].variance) << i;
    EXPECT_LT(fused.without[i].variance, none.without[i].variance) << i;
  }
}

TEST(HeightMeasurement, WhatAllPointsHaveInCommonIsInTheHeightsWithoutARegion) {
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();
  common(1, 1) = 1e-3 * 1e-3;
  const MeasuredHeight with = withPoints(common), without = withPoints(Eigen::Matrix3d::Zero());
  // dh = -h^2 n.dg, and g is wrong along y.
  const double by_common = std::pow(10 * 10 * stereoAt(0, 10).plane.normal().y() * 1e-3, 2);
  for (int i = indexOf(FaultySource::kNear); i <= indexOf(FaultySource::kRight); ++i)
    EXPECT_NEAR(with.without[i].variance - without.without[i].variance, by_common, 0.02 * by_common) << i;
}

}  // namespace
}  // namespace uav_landing
