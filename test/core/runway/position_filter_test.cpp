#include "runway/position/position_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace uav_landing {
namespace {

constexpr double kHeight = 10;
constexpr double kPeriod = 0.1;

/// A level camera that flies 2 m forward and 0.1 m to the left in every step, over a runway 30 m wide.
struct Flight {
  PositionFilter filter{KalmanHeightParameters()};
  int frame = 0;
  double x = -100, y = 3;
  double x_error = 0, x_systematic = 0;  // of x as seen, and what is claimed of it, m
  double other_runway = 0;               // probability
  double heading = 0;                    // of the direction that is seen, right of the runway's, rad
  double width = 30;                     // m
  int sources = kCentreSources;          // that the centre is also seen without
  double sources_error = 0, sources_stddev = 0.1;  // of that centre, m

  /// x_seen, y_seen: whether the runway is seen. error: of y as seen, m.
  LandingResult next(bool x_seen, bool y_seen, double error = 0) {
    x += 2;
    y += 0.1;
    ApproachAngleResult approach;
    approach.vanishing_direction = {std::sin(heading), 0, std::cos(heading)};
    approach.other_runway_probability = other_runway;
    approach.step.duration = kPeriod;
    approach.step.rotation.setZero();
    approach.step.translation_over_height = Eigen::Vector3d(-0.1, 0, 2) / kHeight;
    approach.runway.failure = {Reason::kNoRunway, ""};
    approach.runway.threshold_failure = {Reason::kNoRunway, ""};
    if (y_seen) {
      approach.runway.failure = {};
      approach.runway.y = (y + error) / kHeight;
      approach.runway.width = width / kHeight;
      approach.runway.y_variance = approach.runway.width_variance = std::pow(0.1 / kHeight, 2);
      for (int i = 0; i < sources; ++i)
        approach.runway.y_without.without[i] = {(y + sources_error) / kHeight,
                                                std::pow(sources_stddev / kHeight, 2)};
    }
    if (x_seen) {
      approach.runway.threshold_failure = {};
      approach.runway.x = (x + x_error) / kHeight;
      approach.runway.x_systematic_variance = std::pow(x_systematic / kHeight, 2);
      approach.runway.x_variance = std::pow(0.5 / kHeight, 2) + approach.runway.x_systematic_variance;
    }
    LandingResult result;
    result.stamp = kPeriod * frame++;
    filter.process(approach, Eigen::Vector3d::UnitY(), approach.step, {kHeight, 1e-4, 0.2}, result);
    return result;
  }
};

TEST(PositionFilter, KnowsNothingBeforeTheRunwayIsSeen) {
  Flight flight;
  const LandingResult result = flight.next(false, false);
  EXPECT_TRUE(std::isnan(result.x) && std::isnan(result.y) && std::isnan(result.runway_width));
}

TEST(PositionFilter, ScalesWhatIsSeenByTheHeight) {
  Flight flight;
  const LandingResult result = flight.next(true, true);
  EXPECT_NEAR(result.x, flight.x, 1e-9);
  EXPECT_NEAR(result.y, flight.y, 1e-9);
  EXPECT_NEAR(result.runway_width, 30, 1e-9);
  // The height's 0.1 % makes 0.1 % of the distance besides.
  EXPECT_NEAR(result.x_variance, 0.25 + std::pow(98 * 0.001, 2), 1e-6);
}

TEST(PositionFilter, TheThresholdIsNotKnownFromTheEdges) {
  Flight flight;
  const LandingResult result = flight.next(false, true);
  EXPECT_FALSE(std::isnan(result.y));
  EXPECT_TRUE(std::isnan(result.x));
}

TEST(PositionFilter, FollowsTheMotionWithGrowingVarianceWhileNothingIsSeen) {
  Flight flight;
  double variance = flight.next(true, true).y_variance;
  for (int i = 0; i < 20; ++i) {
    const LandingResult result = flight.next(false, false);
    EXPECT_NEAR(result.x, flight.x, 1e-9);
    EXPECT_NEAR(result.y, flight.y, 1e-9);
    EXPECT_GT(result.y_variance, variance);
    variance = result.y_variance;
  }
}

TEST(PositionFilter, AStepOverTwoPairsOfWhichTheFirstWasGuessedCountsOnce) {
  PositionFilter filter{KalmanHeightParameters()};
  LandingResult result;
  const auto process = [&](double stamp, double duration, bool seen) {
    ApproachAngleResult approach;
    approach.vanishing_direction = Eigen::Vector3d::UnitZ();
    approach.other_runway_probability = 0;
    if (duration > 0) {
      approach.step.duration = duration;
      approach.step.rotation.setZero();
      approach.step.translation_over_height = 20 * duration / kHeight * Eigen::Vector3d::UnitZ();
    } else {
      approach.step.failure = {Reason::kNoMotion, ""};
    }
    approach.runway.failure = approach.runway.threshold_failure = {Reason::kNoRunway, ""};
    if (seen) {
      approach.runway.failure = approach.runway.threshold_failure = {};
      approach.runway.x = -100 / kHeight;
      approach.runway.y = 0;
      approach.runway.width = 3;
      approach.runway.x_variance = approach.runway.y_variance = approach.runway.width_variance = 1e-6;
    }
    result = {};
    result.stamp = stamp;
    filter.process(approach, Eigen::Vector3d::UnitY(), approach.step, {kHeight, 1e-4, kUnknown}, result);
  };
  process(1, 0.1, true);
  process(1.1, 0.1, false);  // 2 m
  process(1.2, 0, false);    // the picture once more: 2 m by the speed
  process(1.3, 0.2, false);  // 4 m since 1.1 s
  EXPECT_NEAR(result.x, -94, 0.1);
}

TEST(PositionFilter, ASystematicErrorDoesNotAverageOut) {
  Flight flight;
  flight.x_error = flight.x_systematic = 3;
  LandingResult result;
  for (int i = 0; i < 100; ++i) result = flight.next(true, true);
  EXPECT_NEAR(result.x, flight.x + 3, 0.1);
  EXPECT_GT(std::sqrt(result.x_variance), 3);
  EXPECT_LT(std::sqrt(result.x_variance), 3.2);
}

TEST(PositionFilter, OneSightWithoutTheSystematicErrorTellsItForThoseAfter) {
  Flight flight;
  flight.x_error = flight.x_systematic = 3;
  for (int i = 0; i < 20; ++i) flight.next(true, true);
  flight.x_error = flight.x_systematic = 0;
  LandingResult result = flight.next(true, true);
  EXPECT_NEAR(result.x, flight.x, 0.1);
  EXPECT_LT(std::sqrt(result.x_variance), 0.6);
  flight.x_error = flight.x_systematic = 3;
  for (int i = 0; i < 20; ++i) result = flight.next(true, true);
  EXPECT_NEAR(result.x, flight.x, 0.2);
  EXPECT_LT(std::sqrt(result.x_variance), 0.8);
}

/// Flies straight on at 20 m/s; for half a second nothing is seen, and after that the motion alone.
struct Blind {
  PositionFilter filter{KalmanHeightParameters()};
  LandingResult result;
  double stamp = 0;

  /// turn: what is known of the camera's rotation. heading: of the camera to the right of the runway, rad.
  void next(bool runway, bool motion, const std::optional<Eigen::Vector3d>& turn, double heading) {
    ApproachAngleResult approach;
    const Eigen::Vector3d along(-std::sin(heading), 0, std::cos(heading));
    approach.other_runway_probability = 0;
    if (runway) approach.vanishing_direction = along;
    approach.step.failure = {Reason::kNoMotion, ""};
    if (motion) {
      approach.step.failure = {};
      approach.step.duration = kPeriod;
      approach.step.rotation.setZero();
      approach.step.translation_over_height = 20 * kPeriod / kHeight * along;
    }
    approach.runway.failure = approach.runway.threshold_failure = {Reason::kNoRunway, ""};
    if (runway) {
      approach.runway.failure = {};
      approach.runway.y = 0;
      approach.runway.width = 3;
      approach.runway.y_variance = approach.runway.width_variance = 1e-6;
      approach.runway.y_without.without.fill({0, 1e-6});
    }
    ApproachAngleResult::Motion turned;
    if (turn) turned.rotation = *turn;
    result = {};
    result.stamp = stamp += kPeriod;
    filter.process(approach, Eigen::Vector3d::UnitY(), turned, {kHeight, 1e-4, 0.2}, result);
  }
};

TEST(PositionFilter, TurnsThatNobodySawMakeTheWayAcrossUncertain) {
  // The camera turns right by 0.07 rad while nothing is seen.
  const double turned = 0.07;
  const auto fly = [&](const std::optional<Eigen::Vector3d>& turn) {
    Blind flight;
    for (int i = 0; i < 3; ++i) flight.next(true, true, Eigen::Vector3d(0, 0, 0), 0);
    for (int i = 1; i <= 5; ++i) flight.next(false, false, turn, turned * i / 5);
    for (int i = 0; i < 10; ++i) flight.next(false, true, Eigen::Vector3d(0, 0, 0), turned);
    return flight.result;
  };
  const LandingResult unseen = fly(std::nullopt);
  EXPECT_GT(std::abs(unseen.y), 1) << "0.07 of 20 m";
  EXPECT_LT(std::abs(unseen.y), 3 * std::sqrt(unseen.y_variance));
  // What the camera sees turns the other way.
  const LandingResult told = fly(Eigen::Vector3d(0, -turned / 5, 0));
  EXPECT_NEAR(told.y, 0, 0.1);
  EXPECT_LT(told.y_variance, 0.7 * unseen.y_variance);
}

TEST(PositionFilter, IsGivenUpWhenItSaysLittle) {
  Flight flight;
  flight.next(true, true);
  int frames = 0;
  while (frames < 10000 && !std::isnan(flight.next(false, false).y)) ++frames;
  EXPECT_GT(frames, 50) << "100 m";
  EXPECT_LT(frames, 2000) << "4 km";
}

TEST(PositionFilter, LeavesOutOneOutlierButBelievesASecondOfThem) {
  Flight flight;
  for (int i = 0; i < 5; ++i) flight.next(true, true);
  const LandingResult outlier = flight.next(true, true, 4);
  EXPECT_NEAR(outlier.y, flight.y, 0.05);
  flight.sources_error = 4;
  for (int i = 0; i < 12; ++i) flight.next(true, true, 4);
  const LandingResult believed = flight.next(true, true, 4);
  EXPECT_NEAR(believed.y, flight.y + 4, 0.05);
}

TEST(PositionFilter, AWidthIsAsUncertainAsItIsSeenAndAsTheHeightMakesIt) {
  Flight flight;
  const LandingResult result = flight.next(true, true);
  // 0.1 m as it is seen, and 30 m by a height that is known to a thousandth.
  EXPECT_NEAR(result.runway_width_variance, std::pow(0.1, 2) + std::pow(0.03, 2), 1e-9);
  EXPECT_NEAR(result.y_variance, std::pow(0.1, 2) + std::pow(3.1e-3, 2), 1e-9);
}

TEST(PositionFilter, ItsProtectionLevelCoversWhatTheSourcesContradict) {
  Flight agreed, off;
  LandingResult level, wrong;
  for (int i = 0; i < 5; ++i) {
    level = agreed.next(false, true);
    wrong = off.next(false, true, 0.3);  // each source is 0.3 m from all together
  }
  EXPECT_GT(level.y_protection_level, 4 * std::sqrt(level.y_variance));
  EXPECT_LT(level.y_protection_level, 5 * std::sqrt(level.y_variance));
  EXPECT_GT(wrong.y_protection_level, 0.3);
  const double seen = level.y_protection_level;
  for (int i = 0; i < 5; ++i) level = agreed.next(false, false);
  EXPECT_GT(level.y_protection_level, seen) << "by the motion alone";
}

TEST(PositionFilter, IsNotKnownWhereItsSourcesContradictByWhatMatters) {
  const auto known = [](double off, double width, double sources_stddev) {
    Flight flight;
    flight.width = width;
    flight.sources_error = off;
    flight.sources_stddev = sources_stddev;
    for (int i = 0; i < 4; ++i) flight.next(false, true);
    return !std::isnan(flight.next(false, true).y);
  };
  EXPECT_TRUE(known(1.4, 30, 0.1));
  EXPECT_FALSE(known(1.6, 30, 0.1)) << "1.5 m matter";
  EXPECT_TRUE(known(1.6, 60, 0.1));
  EXPECT_FALSE(known(1.9, 60, 0.1)) << "3 % of 60 m";
  EXPECT_TRUE(known(1.9, 60, 1)) << "less than 5 sigma";
}

TEST(PositionFilter, AContradictionLastsUntilAMeasurementAgrees) {
  Flight flight;
  flight.sources_error = 3;
  for (int i = 0; i < 15; ++i) flight.next(false, true);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(std::isnan(flight.next(false, false).y)) << i;
  flight.sources_error = 0;
  int until = 0;
  while (until < 30 && std::isnan(flight.next(false, true).y)) ++until;
  EXPECT_LT(until, 15) << "outliers are believed after a second";
}

TEST(PositionFilter, OneSourceIsEnoughToContradict) {
  Flight flight;
  flight.sources_error = 3;
  flight.sources = 1;
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(std::isnan(flight.next(false, true).y)) << i;
}

TEST(PositionFilter, ADirectionThatMayBeARoadsDoesNotSteerIt) {
  Flight flight;
  for (int i = 0; i < 3; ++i) flight.next(true, true);
  flight.heading = 0.1;
  flight.other_runway = 0.02;
  for (int i = 0; i < 10; ++i) {
    const LandingResult result = flight.next(false, false);
    EXPECT_NEAR(result.y, flight.y, 0.05) << "0.2 m a step along the road";
    EXPECT_NEAR(result.x, flight.x, 0.05);
  }
}

TEST(PositionFilter, WhatNothingChecksIsCarriedNoLongerThanItWasSeenForLessThanASecond) {
  for (const bool checked : {true, false}) {
    Flight flight;
    if (!checked) flight.sources = 0;
    flight.next(false, false);
    for (int i = 0; i < 4; ++i) EXPECT_FALSE(std::isnan(flight.next(false, true).y)) << i;
    int carried = 0;
    while (carried < 10 && !std::isnan(flight.next(false, false).y)) ++carried;
    EXPECT_NEAR(carried, checked ? 10 : 4, 1);
    for (int i = 0; i < 8; ++i) EXPECT_FALSE(std::isnan(flight.next(false, true).y)) << "seen again";
    for (int i = 0; i < 20; ++i) flight.next(false, false);
    EXPECT_FALSE(std::isnan(flight.next(false, false).y)) << "seen for more than a second";
  }
}

TEST(PositionFilter, NoProtectionLevelBeforeTheRunwayIsSeen) {
  Flight flight;
  EXPECT_TRUE(std::isnan(flight.next(false, false).y_protection_level));
  EXPECT_FALSE(std::isnan(flight.next(false, true).y_protection_level));
}

}  // namespace
}  // namespace uav_landing
