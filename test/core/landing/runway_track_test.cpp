#include "landing/report/runway_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing {
namespace {

ApproachAngleResult::Sight sightAt(const Eigen::Vector3d& position, const Eigen::Vector3d& stddev) {
  ApproachAngleResult::Sight sight;
  sight.position = position;
  sight.covariance = stddev.cwiseAbs2().asDiagonal();
  sight.height_by_chart = position.z();
  return sight;
}

TEST(RunwayTrack, SmoothsWhatPairsDoNotHaveInCommon) {
  RunwayTrack track({});
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d stddev(150, 10, 12);
  TrackedPosition found;
  Eigen::Vector3d truth;
  for (int i = 0; i < 60; ++i) {
    truth = {-3000 + 12.0 * i, 5, 160 - 0.63 * i};
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    found = track.follow(i == 0 ? 0 : 0.2, sightAt(truth + stddev.cwiseProduct(noise), stddev));
  }
  ASSERT_TRUE(found.known());
  for (int i = 0; i < 3; ++i) {
    const double claimed = std::sqrt(found.variance[i]);
    EXPECT_LT(claimed, 0.95 * stddev[i]);
    EXPECT_GT(claimed, 0.8 * stddev[i]) << "texture and paint are the same in all pairs";
    EXPECT_LT(std::abs(found.position[i] - truth[i]), 3 * claimed);
  }
}

TEST(RunwayTrack, GoesOnWithoutAPairAndForgetsAnOutlineThatWasRejected) {
  for (const Reason reason : {Reason::kNoRunway, Reason::kInconsistent, Reason::kRejected}) {
    RunwayTrack track({});
    for (int i = 0; i < 10; ++i)
      track.follow(i == 0 ? 0 : 0.2, sightAt({-1500 + 12.0 * i, 0, 80 - 0.63 * i}, {5, 1, 0.3}));
    ApproachAngleResult::Sight missing;
    missing.failure = {reason, "for the test"};
    const TrackedPosition found = track.follow(0.2, missing);
    EXPECT_EQ(found.known(), reason != Reason::kRejected) << toString(reason);
    if (found.known()) {
      EXPECT_NEAR(found.position.x(), -1380, 5);
    }
    EXPECT_EQ(track.follow(0.2, missing).known(), reason != Reason::kRejected) << toString(reason);
  }
}

TEST(RunwayTrack, TheProtectionLevelHoldsForAChartThatIsATenthOff) {
  RunwayTrack track({});
  TrackedPosition found;
  for (int i = 0; i < 30; ++i)
    found = track.follow(i == 0 ? 0 : 0.2, sightAt({-1500 + 12.0 * i, 0, 80 - 0.63 * i}, {5, 1, 0.3}));
  EXPECT_GT(found.protection_level, 0.10 * found.position.z());
  EXPECT_LT(found.protection_level, 0.15 * found.position.z());
}

TEST(RunwayTrack, TheProtectionLevelHoldsForACalibrationThatIsFarOff) {
  RunwayTrack track({}), by_stereo({});
  double level = 0, with_bias = 0, height = 0;
  for (int i = 0; i < 30; ++i) {
    ApproachAngleResult::Sight sight = sightAt({-1500 + 12.0 * i, 0, 80 - 0.63 * i}, {5, 1, 0.3});
    sight.height_by_chart = 0.1 * sight.position.z();
    level = track.follow(i == 0 ? 0 : 0.2, sight).protection_level;
    sight.height_by_bias = 0.03 * sight.position.z();
    const TrackedPosition found = by_stereo.follow(i == 0 ? 0 : 0.2, sight);
    with_bias = found.protection_level;
    height = found.position.z();
  }
  EXPECT_LT(level, 0.05 * height) << "the chart hardly matters";
  EXPECT_GT(with_bias, 5 * 0.03 * height);
  EXPECT_LT(with_bias, 6 * 0.03 * height);
}

TEST(RunwayTrack, WithoutKnownInfluencesThereIsNoLevel) {
  RunwayTrack track({});
  ApproachAngleResult::Sight sight = sightAt({-1500, 0, 80}, {5, 1, 0.3});
  sight.height_by_bias = kUnknown;
  EXPECT_TRUE(std::isnan(track.follow(0, sight).protection_level));
}

TEST(RunwayTrack, AnElementThatContradictsRaisesTheLevel) {
  RunwayTrack plain({}), contradicted({});
  double level = 0;
  for (int i = 0; i < 30; ++i) {
    ApproachAngleResult::Sight sight = sightAt({-1500 + 12.0 * i, 0, 80 - 0.63 * i}, {5, 1, 0.3});
    level = plain.follow(i == 0 ? 0 : 0.2, sight).protection_level;
    sight.height_without[0] = sight.position.z() - 12;
    sight.variance_without[0] = 1;
    const TrackedPosition found = contradicted.follow(i == 0 ? 0 : 0.2, sight);
    if (i == 29) {
      EXPECT_GT(found.protection_level, 12);
    }
  }
  EXPECT_LT(level, 10);
}

TEST(RunwayTrack, AnElementThatDiffersByLessThanItsErrorLeavesTheLevelAsItIs) {
  RunwayTrack plain({}), uncertain({});
  for (int i = 0; i < 30; ++i) {
    ApproachAngleResult::Sight sight = sightAt({-1500 + 12.0 * i, 0, 80 - 0.63 * i}, {5, 1, 0.3});
    const double level = plain.follow(i == 0 ? 0 : 0.2, sight).protection_level;
    sight.height_without[0] = sight.position.z() - 12;
    sight.variance_without[0] = 10 * 10;
    EXPECT_EQ(uncertain.follow(i == 0 ? 0 : 0.2, sight).protection_level, level) << i;
  }
}

TEST(RunwayTrack, ASizeThatStereoContradictsTakesThePositionAway) {
  RunwayTrack track({});
  TrackedPosition found;
  for (int i = 0; i < 10; ++i) {
    ApproachAngleResult::Sight sight = sightAt({-800 + 12.0 * i, 0, 45}, {5, 1, 0.3});
    sight.size_over_chart = 0.9;
    sight.size_over_chart_variance = 1e-4;
    found = track.follow(i == 0 ? 0 : 0.2, sight);
    if (i == 1) {
      EXPECT_TRUE(found.known()) << "one or two pairs may be wrong";
    }
  }
  EXPECT_EQ(found.contradiction.reason, Reason::kInconsistent);
  EXPECT_NE(found.contradiction.detail.find("runway/width"), std::string::npos);
  EXPECT_FALSE(found.known());
}

TEST(RunwayTrack, OnlyASizeThatIsMeasuredWellBringsThePositionBack) {
  RunwayTrack track({});
  bool first = true;
  const auto knownAfterTen = [&](double size, double stddev) {
    TrackedPosition found;
    for (int i = 0; i < 10; ++i) {
      ApproachAngleResult::Sight sight = sightAt({-800, 0, 45}, {5, 1, 0.3});
      sight.size_over_chart = size;
      sight.size_over_chart_variance = stddev * stddev;
      found = track.follow(first ? 0 : 0.2, sight);
      first = false;
    }
    return found.known();
  };
  EXPECT_FALSE(knownAfterTen(0.9, 0.01));
  EXPECT_FALSE(knownAfterTen(1, 0.2)) << "says nothing against a tenth less";
  EXPECT_TRUE(knownAfterTen(1, 0.01));
}

TEST(RunwayTrack, CarriesOnByTheSpeedForSomeSeconds) {
  RunwayTrack track({});
  RunwayVelocity velocity;
  velocity.value = {60, 0, -3};
  velocity.variance.setConstant(0.01);
  TrackedPosition found;
  for (int i = 0; i < 20; ++i)
    found =
        track.follow(i == 0 ? 0 : 0.2, sightAt({-800 + 12.0 * i, 1, 45 - 0.6 * i}, {5, 1, 0.3}), velocity);
  ApproachAngleResult::Sight gone;
  gone.failure = {Reason::kNoRunway, "near"};
  for (int i = 20; i < 45; ++i) found = track.follow(0.2, gone, velocity);
  ASSERT_TRUE(found.known());
  EXPECT_FALSE(found.measured);
  EXPECT_NEAR(found.position.x(), -800 + 12.0 * 44, 6);
  EXPECT_NEAR(found.position.z(), 45 - 0.6 * 44, 1);
  for (int i = 0; i < 60; ++i) found = track.follow(0.2, gone, velocity);
  EXPECT_FALSE(found.known()) << "not for ever";
}

TEST(RunwayTrack, OnePairThatIsFarOffChangesNothing) {
  RunwayTrack track({});
  TrackedPosition found;
  for (int i = 0; i < 20; ++i)
    found = track.follow(i == 0 ? 0 : 0.2, sightAt({-800 + 12.0 * i, 1, 45}, {5, 1, 0.3}));
  const double before = found.position.z();
  found = track.follow(0.2, sightAt({-400, 1, 60}, {5, 1, 0.3}));
  EXPECT_NEAR(found.position.z(), before, 0.5);
}

}  // namespace
}  // namespace uav_landing
