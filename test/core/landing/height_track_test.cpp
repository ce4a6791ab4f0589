#include "landing/height/height_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kStep;
using test::measuredHeight;

/// A track with the time of its pairs.
class Pairs {
 public:
  explicit Pairs(const KalmanHeightParameters& parameters = {}) : track(parameters, 0) {}

  HeightTrack track;

  TrackVerdict see(const MeasuredHeight& measured, const VerticalSpeed& speed = {}) {
    return next(measured, false, speed);
  }
  TrackVerdict see(double height, double stddev = 0.01) { return see(measuredHeight(height, stddev)); }
  TrackVerdict miss() { return next(test::noHeight(), false, {}); }
  TrackVerdict leaveOut(double height) { return next(measuredHeight(height), true, {}); }
  TrackVerdict settle(double height = 10, int pairs = 20) {
    TrackVerdict last = see(height);
    for (int i = 1; i < pairs; ++i) last = see(height);
    return last;
  }

 private:
  TrackVerdict next(const MeasuredHeight& measured, bool left_out, const VerticalSpeed& speed) {
    track.predict(kStep);
    stamp_ += kStep;
    return track.update(stamp_, measured, left_out, speed);
  }

  double stamp_ = 5;
};

TEST(HeightTrack, SearchesUntilThereIsAHeight) {
  Pairs pairs;
  const TrackVerdict verdict = pairs.miss();
  EXPECT_EQ(verdict.status, Status::kSearching);
  EXPECT_FALSE(verdict.height_valid);
  EXPECT_TRUE(std::isnan(verdict.height));
  EXPECT_FALSE(pairs.track.known());
}

TEST(HeightTrack, AHeightIsBelievedOnceThreeInARowAgree) {
  Pairs pairs;
  EXPECT_EQ(pairs.see(10).failure.message(), "not_yet: agreeing heights so far: 1 of 3 needed");
  EXPECT_EQ(pairs.see(10).failure.message(), "not_yet: agreeing heights so far: 2 of 3 needed");
  const TrackVerdict third = pairs.see(10);
  EXPECT_EQ(third.status, Status::kTracking);
  EXPECT_TRUE(third.height_valid && third.confirmed);
  EXPECT_NEAR(third.height, 10, 1e-9);
}

TEST(HeightTrack, WhatTheBaselineIsWrongByDoesNotAverageOutAndChangesNoHeight) {
  Pairs exact, uncertain;
  MeasuredHeight measured = measuredHeight(10);
  const TrackVerdict without = exact.settle();
  measured.errors.baseline = 0.01;
  TrackVerdict with = uncertain.see(measured);
  for (int i = 1; i < 20; ++i) with = uncertain.see(measured);
  EXPECT_EQ(with.height, without.height);
  EXPECT_NEAR(std::sqrt(with.height_variance - without.height_variance), 0.1, 1e-3) << "1 % of 10 m";
  const double level = uncertain.track.protectionLevel(10, with.height_variance, std::nullopt).bound;
  EXPECT_GT(level, 4.4 * 0.1) << "1e-5 to both sides: 4.42 sigma";
}

TEST(HeightTrack, WhatTheBaselineIsWrongByFollowsTheHeight) {
  Pairs pairs;
  TrackVerdict last = pairs.see(20);
  for (int i = 1; i <= 200; ++i) {
    MeasuredHeight measured = measuredHeight(20 - 0.05 * i);
    measured.errors.baseline = 0.01;
    last = pairs.see(measured);
  }
  EXPECT_NEAR(last.height, 10, 0.02);
  EXPECT_NEAR(std::sqrt(last.height_variance), 0.1, 0.01);
}

TEST(HeightTrack, OfTwoFirstHeightsThatContradictEachOtherTheNewOneIsTaken) {
  Pairs pairs;
  pairs.see(17);
  const TrackVerdict second = pairs.see(10);
  EXPECT_EQ(second.rejection.reason, Reason::kRejected);
  EXPECT_NEAR(second.height, 10, 1e-9);
  EXPECT_FALSE(second.height_valid);
  EXPECT_EQ(pairs.track.resets(), 1);
  pairs.see(10);
  EXPECT_TRUE(pairs.see(10).height_valid);
}

TEST(HeightTrack, ALostTrackHasNoRejectionsInARow) {
  KalmanHeightParameters parameters;
  parameters.reset_timeout = 1;
  Pairs pairs(parameters);
  pairs.settle();
  TrackVerdict verdict = pairs.leaveOut(14);
  for (int i = 1; i < 100 && verdict.status != Status::kLost; ++i) {
    EXPECT_EQ(verdict.consecutive_rejections, i);
    verdict = pairs.leaveOut(14);
  }
  ASSERT_EQ(verdict.status, Status::kLost);
  EXPECT_EQ(verdict.consecutive_rejections, 0);
  EXPECT_EQ(pairs.see(14).consecutive_rejections, 0);
}

TEST(HeightTrack, AnOutlierIsRejectedAndChangesNothing) {
  Pairs pairs;
  pairs.settle();
  const TrackVerdict outlier = pairs.see(14);
  EXPECT_EQ(outlier.rejection.reason, Reason::kRejected);
  EXPECT_EQ(outlier.consecutive_rejections, 1);
  EXPECT_EQ(outlier.status, Status::kCoasting);
  EXPECT_NEAR(outlier.innovation, 4, 1e-6);
  EXPECT_NEAR(outlier.height, 10, 1e-6);
  EXPECT_TRUE(outlier.height_valid) << "for a while";
  const TrackVerdict after = pairs.see(10);
  EXPECT_FALSE(after.rejection);
  EXPECT_EQ(after.consecutive_rejections, 0);
  EXPECT_EQ(pairs.track.resets(), 0);
}

TEST(HeightTrack, TheInnovationIsATestOfThePair) {
  Pairs pairs;
  pairs.settle();
  for (const double height : {10.0, 14.0}) {
    PairTests tests = test::noTests();
    pairs.see(height).addTo(tests);
    EXPECT_EQ(test::failedOf(tests), height > 10 ? "innovation" : "");
    EXPECT_TRUE(tests.result(IntegrityTest::kInnovation).possible());
  }
  PairTests tests = test::noTests();
  pairs.miss().addTo(tests);
  EXPECT_FALSE(tests.result(IntegrityTest::kInnovation).possible());
}

// Eq (7): P + T^2 of the speed's variance + (a T^2 / 2)^2.
TEST(HeightTrack, CoastsWithAVarianceThatGrowsAsTheModelSays) {
  Pairs pairs;
  pairs.see(10, 0.02);
  const TrackVerdict verdict = pairs.miss();
  EXPECT_EQ(verdict.status, Status::kCoasting);
  EXPECT_NEAR(verdict.height_variance,
              0.02 * 0.02 + std::pow(kStep * 5, 2) + std::pow(1.5 * kStep * kStep / 2, 2), 1e-9);
}

TEST(HeightTrack, AHeightIsNotValidAfterMaxAgeWithoutAnother) {
  KalmanHeightParameters parameters;
  parameters.max_age = 0.35;
  Pairs pairs(parameters);
  pairs.settle();
  for (int i = 1; i <= 5; ++i) {
    const TrackVerdict verdict = pairs.miss();
    EXPECT_EQ(verdict.height_valid, i <= 3) << i;
    EXPECT_NEAR(verdict.height, 10, 0.01);
    if (i > 3) {
      EXPECT_EQ(verdict.failure.reason, Reason::kTimeout);
    }
  }
}

TEST(HeightTrack, IsLostAfterTheResetTimeoutAndFindsBack) {
  Pairs pairs;
  pairs.settle();
  for (int i = 0; i < 9; ++i) EXPECT_EQ(pairs.miss().status, Status::kCoasting) << i;
  pairs.miss();
  const TrackVerdict lost = pairs.miss();
  EXPECT_EQ(lost.status, Status::kLost);
  EXPECT_TRUE(std::isnan(lost.height));
  EXPECT_EQ(pairs.track.resets(), 1);
  const TrackVerdict found = pairs.see(4);
  EXPECT_EQ(found.status, Status::kTracking);
  EXPECT_NEAR(found.height, 4, 1e-9);
  EXPECT_FALSE(found.height_valid);
}

TEST(HeightTrack, TakesAnotherHeightThatStaysAfterTheResetTimeout) {
  KalmanHeightParameters parameters;
  parameters.gate = 2;  // narrow, so that coasting alone does not open it
  parameters.acceleration_stddev = 0.1;
  Pairs pairs(parameters);
  pairs.settle();
  int rejected = 0;
  while (pairs.track.resets() == 0 && rejected < 60) {
    const TrackVerdict verdict = pairs.see(20);
    ++rejected;
    EXPECT_FALSE(verdict.height_valid && rejected * kStep > parameters.max_age + 1e-9);
  }
  EXPECT_NEAR(rejected * kStep, parameters.reset_timeout, 1.01 * kStep);
  pairs.see(20);
  const TrackVerdict third = pairs.see(20);
  EXPECT_TRUE(third.height_valid);
  EXPECT_NEAR(third.height, 20, 1e-6);
}

TEST(HeightTrack, IsOutdatedByPairsThatAreLeftOutButNotByPairsThatMeasureNothing) {
  Pairs missed, left_out;
  missed.settle();
  left_out.settle();
  for (int i = 1; i <= 6; ++i) {
    EXPECT_FALSE(missed.miss().outdated) << i;
    const TrackVerdict verdict = left_out.leaveOut(10);
    EXPECT_EQ(verdict.outdated, i > 3) << "max_age of 0.3 s, " << i;
    EXPECT_EQ(verdict.consecutive_rejections, i);
    EXPECT_EQ(verdict.status, Status::kCoasting);
  }
}

TEST(HeightTrack, AHeightThatIsGivenUpCountsOnce) {
  HeightTrack track({}, 3);
  track.lose();
  EXPECT_EQ(track.resets(), 3) << "there was none";
  EXPECT_EQ(track.status(), Status::kSearching);
  track.update(1, measuredHeight(10), false, {});
  EXPECT_TRUE(track.known());
  track.lose();
  track.lose();
  EXPECT_EQ(track.resets(), 4);
  EXPECT_EQ(track.status(), Status::kLost);
}

TEST(HeightTrack, AnUncertainHeightIsNotValid) {
  Pairs pairs;
  pairs.see(10, 1);
  pairs.see(10, 1);
  EXPECT_EQ(pairs.see(10, 1).failure.reason, Reason::kUncertain) << "3 sigma above 5 % of it";
}

TEST(HeightTrack, ThePriorIsWhatThePairsBeforeExpect) {
  Pairs pairs;
  EXPECT_FALSE(pairs.track.predict(kStep).known());
  EXPECT_EQ(pairs.track.predict(kStep).heightOr(7), 7);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(pairs.track.predict(0).confirmed()) << i;
    pairs.see(measuredHeight(10 - 0.2 * i), {-2, 1e-4});
  }
  const HeightPrior prior = pairs.track.predict(kStep);
  EXPECT_TRUE(prior.confirmed());
  EXPECT_NEAR(prior.heightOr(7), 9.4, 0.02) << "2 m/s further down";
}

TEST(HeightTrack, TakesTheVerticalSpeedOfTheMotion) {
  Pairs with, without;
  for (int i = 0; i < 2; ++i) {
    with.see(measuredHeight(10 - 0.2 * i, 0.05), {-2, 0.1 * 0.1});
    without.see(10 - 0.2 * i, 0.05);
  }
  const TrackVerdict by_motion = with.see(measuredHeight(9.6, 0.05), {-2, 0.1 * 0.1});
  EXPECT_NEAR(by_motion.vertical_speed, -2, 0.05);
  EXPECT_LT(std::sqrt(by_motion.vertical_speed_variance), 0.1);
  EXPECT_GT(std::sqrt(without.see(9.6, 0.05).vertical_speed_variance), 0.2);
}

TEST(HeightTrack, AMotionOfAPairWhoseHeightIsRejectedTellsNoSpeed) {
  Pairs pairs;
  pairs.settle();
  EXPECT_NEAR(pairs.see(measuredHeight(14), {0.3, 1e-6}).vertical_speed, 0, 1e-6);
}

/// Heights that scatter by so much and claim 0.06 m, with a motion that knows the speed to 0.2 m/s.
TrackVerdict afterScatter(double stddev, bool by_motion, const KalmanHeightParameters& parameters) {
  Pairs pairs(parameters);
  std::mt19937 random(5);
  std::normal_distribution<double> error(0, stddev);
  for (int i = 0; i < 59; ++i)
    pairs.see(measuredHeight(10 + error(random), 0.06), by_motion ? VerticalSpeed{0, 0.04} : VerticalSpeed());
  return pairs.see(measuredHeight(10, 0.06), by_motion ? VerticalSpeed{0, 0.04} : VerticalSpeed());
}

TEST(HeightTrack, HeightsThatScatterMoreThanTheyClaimHaveAVarianceThatSaysSo) {
  KalmanHeightParameters parameters;
  const TrackVerdict honest = afterScatter(0.05, true, parameters),
                     bold = afterScatter(0.15, true, parameters);
  EXPECT_GT(bold.height_variance, 1.5 * honest.height_variance);
  EXPECT_NEAR(bold.vertical_speed_variance, honest.vertical_speed_variance,
              0.01 * honest.vertical_speed_variance)
      << "by the motion";
  parameters.use_motion = false;
  EXPECT_GT(afterScatter(0.15, false, parameters).vertical_speed_variance,
            1.5 * afterScatter(0.05, false, parameters).vertical_speed_variance);
  parameters.integrity_monitor = false;
  EXPECT_NEAR(afterScatter(0.15, true, parameters).height_variance,
              afterScatter(0.05, true, parameters).height_variance, 1e-5)
      << "as claimed";
}

TEST(HeightTrack, MotionsThatScatterMoreThanTheyClaimHaveASpeedThatSaysSo) {
  const auto after = [](double stddev) {
    Pairs pairs;
    std::mt19937 random(6);
    std::normal_distribution<double> error(0, stddev);
    for (int i = 0; i < 59; ++i) pairs.see(measuredHeight(10, 0.06), {error(random), 0.2 * 0.2});
    return pairs.see(measuredHeight(10, 0.06), {0, 0.2 * 0.2}).vertical_speed_variance;
  };
  EXPECT_NEAR(after(0.1), after(0), 1e-9);
  EXPECT_GT(after(0.6), 1.25 * after(0));
}

/// A height of 10 m to 0.01 m; without the far points it would be another one.
MeasuredHeight withoutFar(double height) {
  MeasuredHeight measured = measuredHeight(10);
  measured.without.fill({10, 0.01 * 0.01, {}});
  measured.without[static_cast<int>(FaultySource::kFar)].height = height;
  return measured;
}

TEST(HeightTrack, TheProtectionLevelIsOfTheSourceThatTheHeightHangsOnMost) {
  // Of a fault of 1e-3 and a risk of 1e-5 an error may exceed k sigma with 1e-2: k = 2.576.
  for (const double height : {10.0, 10.5}) {
    Pairs pairs;
    TrackVerdict verdict = pairs.see(withoutFar(height));
    for (int i = 0; i < 100; ++i) verdict = pairs.see(withoutFar(height));
    const SolutionSeparation::Level level =
        pairs.track.protectionLevel(verdict.height, verdict.height_variance, std::nullopt);
    // 2 % of the height are by assumption.
    const double expected = (height > 10 ? 0.5 : 0.2) + 2.576 * std::sqrt(verdict.height_variance);
    EXPECT_NEAR(level.bound, expected, 1e-3);
    EXPECT_STREQ(level.source, height > 10 ? "far_region" : "scale");
  }
}

}  // namespace
}  // namespace uav_landing
