#include "motion/step/turn_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "geometry/rotation.h"

namespace uav_landing {
namespace {

constexpr double kPeriod = 0.05;  // s
const Eigen::Vector3d kAxis(0.6, 0, 0.8);

/// Angle about kAxis at a time, rad.
using Angle = std::function<double(double)>;

CameraMotion turnedBy(double angle) {
  return {rotationMatrix(angle * kAxis), Eigen::Vector3d(0.1, 0.2, 0.3)};
}

double rateOf(const Angle& angle, double t) { return (angle(t + 1e-5) - angle(t - 1e-5)) / 2e-5; }

/// History of the steps up to a time, each with an error of its rotation.
TurnHistory historyOf(const Angle& angle, int steps, double noise = 0) {
  std::mt19937 random(3);
  std::normal_distribution<double> error(0, noise);
  TurnHistory history;
  for (int i = 0; i < steps; ++i)
    history.add(turnedBy(angle((i + 1) * kPeriod) - angle(i * kPeriod) + (noise > 0 ? error(random) : 0)),
                kPeriod);
  return history;
}

/// Errors of the rates in the step after so many others, rad/s.
struct Errors {
  double then, now;
};

Errors errorsOf(const TurnHistory& history, const Angle& angle, int steps) {
  const double begin = steps * kPeriod, end = begin + kPeriod;
  const StepEnds ends = history.ends(turnedBy(angle(end) - angle(begin)), kPeriod, 1);
  return {kAxis.dot(ends.then.w) - rateOf(angle, begin), kAxis.dot(ends.now.w) - rateOf(angle, end)};
}

double doubtOf(const TurnHistory& history) { return std::sqrt(kAxis.dot(history.doubt(kPeriod) * kAxis)); }

TEST(TurnHistory, TakesTheFirstStepForEven) {
  const CameraMotion step = turnedBy(0.02);
  const StepEnds ends = TurnHistory().ends(step, kPeriod, 1.1);
  EXPECT_LT((ends.now.w - 0.02 / kPeriod * kAxis).norm(), 1e-9);
  EXPECT_LT((ends.then.w - 0.02 / kPeriod * kAxis).norm(), 1e-9);
  EXPECT_TRUE(ends.now.a.isZero(0));
  EXPECT_LT((ends.now.v - step.t / kPeriod).norm(), 1e-12);
  EXPECT_LT((ends.then.v - step.R.transpose() * step.t / kPeriod / 1.1).norm(), 1e-12);
  EXPECT_TRUE(TurnHistory().doubt(kPeriod).isZero(0)) << "nothing tells";
}

TEST(TurnHistory, KnowsATurnThatGetsFaster) {
  const Angle angle = [](double t) { return 0.1 * t + 0.8 * t * t; };
  for (const int steps : {1, 2, 12}) {
    const TurnHistory history = historyOf(angle, steps);
    const Errors errors = errorsOf(history, angle, steps);
    EXPECT_NEAR(errors.then, 0, 1e-6) << steps;
    EXPECT_NEAR(errors.now, 0, 1e-6) << steps;
    const double begin = steps * kPeriod;
    const StepEnds ends = history.ends(turnedBy(angle(begin + kPeriod) - angle(begin)), kPeriod, 1);
    EXPECT_NEAR(kAxis.dot(ends.now.a), 1.6, 1e-6) << steps;
  }
}

TEST(TurnHistory, KnowsItWithStepsOfDifferentDurationsToo) {
  const Angle angle = [](double t) { return 0.1 * t + 0.8 * t * t; };
  TurnHistory history;
  double t = 0;
  for (const double duration : {0.05, 0.1, 0.03, 0.05, 0.15}) {
    history.add(turnedBy(angle(t + duration) - angle(t)), duration);
    t += duration;
  }
  const StepEnds ends = history.ends(turnedBy(angle(t + 0.04) - angle(t)), 0.04, 1);
  EXPECT_NEAR(kAxis.dot(ends.then.w), rateOf(angle, t), 1e-6);
  EXPECT_NEAR(kAxis.dot(ends.now.w), rateOf(angle, t + 0.04), 1e-6);
}

// Roll of 2.5 degrees to and fro within a second.
TEST(TurnHistory, FollowsGustsAndClaimsWhatItMisses) {
  const Angle gusts = [](double t) { return 0.044 * std::sin(2 * M_PI * t); };
  double squares = 0, claims = 0, of_even = 0;
  constexpr int kFirst = 12, kLast = 60;
  for (int steps = kFirst; steps < kLast; ++steps) {
    const TurnHistory history = historyOf(gusts, steps);
    const Errors errors = errorsOf(history, gusts, steps), even = errorsOf(TurnHistory(), gusts, steps);
    squares += std::pow(errors.now - errors.then, 2);
    of_even += std::pow(even.now - even.then, 2);
    claims += std::pow(doubtOf(history), 2);
  }
  EXPECT_LT(squares, 0.04 * of_even);
  EXPECT_LT(squares, 2 * claims);
  EXPECT_GT(squares, 0.25 * claims) << "claims may cover noise as well";
}

TEST(TurnHistory, SmoothsNoiseInCalmAir) {
  constexpr double kNoise = 2e-5;  // rad
  const Angle calm = [](double t) { return 0.02 * t; };
  double squares = 0, claims = 0;
  for (int steps = 50; steps < 90; ++steps) {
    const TurnHistory history = historyOf(calm, steps, kNoise);
    const Errors errors = errorsOf(history, calm, steps);
    squares += std::pow(errors.now - errors.then, 2) / 40;
    claims += std::pow(doubtOf(history), 2) / 40;
  }
  // The highest degree would have 2.55 times the noise of a step.
  EXPECT_LT(std::sqrt(squares), 2 * kNoise / kPeriod);
  EXPECT_LT(std::sqrt(claims), 1.6 * kNoise / kPeriod);
  EXPECT_LT(squares, 2 * claims);
}

TEST(TurnHistory, BeginsAnewAfterAGapAndClaimsTheErrorsSoFar) {
  const Angle gusts = [](double t) { return 0.044 * std::sin(2 * M_PI * t); };
  double squares = 0, claims = 0;
  for (int steps = 20; steps < 60; ++steps) {
    TurnHistory history = historyOf(gusts, steps);
    history.interrupt();
    const Errors errors = errorsOf(history, gusts, steps);
    squares += std::pow(errors.now - errors.then, 2);
    claims += std::pow(doubtOf(history), 2);
    history.add(turnedBy(0.01), kPeriod);
    EXPECT_NEAR(kAxis.dot(history.ends(turnedBy(0.02), kPeriod, 1).now.w), 0.025 / kPeriod, 1e-6)
        << "nothing is left of the steps before the gap";
  }
  EXPECT_LT(squares, 2 * claims);
  EXPECT_GT(squares, 0.3 * claims);
}

// Images that come twice, or stamps that scatter.
TEST(TurnHistory, ClaimsStepsOfOtherDurations) {
  const Angle gusts = [](double t) { return 0.044 * std::sin(2 * M_PI * t); };
  for (const double odd : {0.002, 0.01, 0.1, 0.25}) {
    TurnHistory history = historyOf(gusts, 40);
    const double usual = doubtOf(history);
    double t = 40 * kPeriod;
    const auto error = [&](double duration) {
      const StepEnds ends = history.ends(turnedBy(gusts(t + duration) - gusts(t)), duration, 1);
      return kAxis.dot(ends.now.w - ends.then.w) - (rateOf(gusts, t + duration) - rateOf(gusts, t));
    };
    const auto claim = [&](double duration) { return std::sqrt(kAxis.dot(history.doubt(duration) * kAxis)); };
    for (const double duration : {odd, kPeriod, kPeriod, kPeriod, kPeriod, kPeriod}) {
      EXPECT_LT(std::abs(error(duration)), 4 * claim(duration) + 1e-4) << odd << ' ' << t;
      if (duration == kPeriod) {
        EXPECT_LT(claim(duration), 30 * usual) << odd << ' ' << t;
      }
      history.add(turnedBy(gusts(t + duration) - gusts(t)), duration);
      t += duration;
    }
    for (int i = 0; i < 10; ++i, t += kPeriod) history.add(turnedBy(gusts(t + kPeriod) - gusts(t)), kPeriod);
    EXPECT_LT(claim(kPeriod), 3 * usual) << odd;
  }
}

}  // namespace
}  // namespace uav_landing
