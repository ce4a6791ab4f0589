#include "motion/step/row_shake.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "motion/step/ego_motion.h"
#include "support/motion_matches.h"
#include "support/rolling_camera.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::motionRig;
using test::Pose;

constexpr double kPeriod = 0.05, kReadout = 0.03;  // s

/// A camera that glides level, with its pitch and roll vibrating.
struct Vibration {
  double amplitude = 0, frequency = 37, phase = 0;  // rad, Hz, rad

  Pose pose(double t) const {
    Pose pose;
    pose.position = {20 * t, 0, 27 - 1.9 * t};
    const double p = 2 * M_PI * frequency * t + phase;
    pose.pitch = -5 * kDegree + amplitude * std::sin(p);
    pose.roll = 0.5 * amplitude * std::sin(1.13 * p + 1);
    return pose;
  }
  Eigen::Vector2d seen(double stamp, double readout, const Eigen::Vector3d& world) const {
    return test::rollingPixel([this](double t) { return pose(t); }, motionRig(), stamp, readout, world);
  }
};

constexpr double kNoise = 0.08;  // px
const RowTimes& unitTimes() {
  static const RowTimes times(test::calibrationOf(motionRig()), {1.0, 0.5});
  return times;
}

/// One step of that camera, with matches as its rolling shutter makes them.
struct ShakenStep {
  test::Step truth;
  std::vector<TemporalMatch> matches;

  ShakenStep(const Vibration& vibration, double stamp, unsigned seed)
      : truth(Vibration().pose(stamp - kPeriod), Vibration().pose(stamp)) {
    const Pose level = Vibration().pose(stamp);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, kNoise);
    std::uniform_real_distribution<double> u(10, motionRig().size.width - 10),
        v(215, motionRig().size.height - 10);
    while (matches.size() < 300) {
      const Eigen::Vector3d ray = motionRig().ray(u(random), v(random));
      const double slope = truth.n.dot(ray);
      if (slope < 0.02) continue;
      const Eigen::Vector3d world =
          level.worldFromOptical() * (level.height() / slope * ray) + level.position;
      TemporalMatch match;
      match.now = vibration.seen(stamp, kReadout, world);
      match.then =
          vibration.seen(stamp - kPeriod, kReadout, world) + Eigen::Vector2d(noise(random), noise(random));
      match.covariance = kNoise * kNoise * Eigen::Matrix2d::Identity();
      matches.push_back(match);
    }
  }

  Expected<MotionEstimate> estimate(ShakeMemory* memory, bool rolling = true) const {
    return estimate(memory, rolling, truth.n);
  }
  Expected<MotionEstimate> estimate(ShakeMemory* memory, bool rolling, const Eigen::Vector3d& normal) const {
    constexpr double kSlope = 1e-4;  // rad
    MotionMemory work;
    if (memory != nullptr) memory->begin();
    return estimateMotion(motionRig(), matches,
                          {{truth.movement.R, truth.t},
                           {normal, test::across(normal, kSlope)},
                           nullptr,
                           {{&unitTimes(), memory, rolling}, Eigen::Vector3d::Zero()}},
                          20, work);
  }
  /// Error of the translation across the way, up and down, over its claimed standard deviation.
  double ratio(const MotionEstimate& found) const {
    const Eigen::Vector3d& n = truth.n;
    return n.dot(found.motion.t - truth.t) / std::sqrt(n.dot(found.covariance.block<3, 3>(3, 3) * n));
  }
};

/// Root mean squares of these ratios, with shake and without, and the share of steps that it was found in.
struct Ratios {
  double with = 0, without = 0, found = 0;
};

Ratios ratiosOf(const Vibration& vibration) {
  constexpr int kFirst = 20, kSteps = 80;
  ShakeMemory memory;
  Ratios ratios;
  for (int i = 0; i < kSteps; ++i) {
    const ShakenStep step(vibration, kPeriod * i, i);
    const Expected<MotionEstimate> with = step.estimate(&memory), without = step.estimate(nullptr);
    if (!with || !without || i < kFirst) continue;
    ratios.with += std::pow(step.ratio(*with), 2) / (kSteps - kFirst);
    ratios.without += std::pow(step.ratio(*without), 2) / (kSteps - kFirst);
    ratios.found += !with->of_shake.isZero(0) / double(kSteps - kFirst);
  }
  return {std::sqrt(ratios.with), std::sqrt(ratios.without), ratios.found};
}

TEST(RowShake, OfVibrationIsFoundAndClaimed) {
  for (const double frequency : {37.0, 61.0}) {
    const Ratios ratios = ratiosOf({0.05 * kDegree, frequency, 0});
    EXPECT_GT(ratios.found, 0.99) << frequency;
    EXPECT_GT(ratios.without, 3) << frequency << ": vibration must matter";
    EXPECT_LT(ratios.with, 0.5 * ratios.without) << frequency;
    EXPECT_LT(ratios.with, 3) << frequency;
  }
}

TEST(RowShake, IsFoundAsWellWhereNothingIsToldOfTheRows) {
  ShakeMemory memory, memory_of_untold;
  for (int i = 0; i < 20; ++i) {
    const ShakenStep step({0.05 * kDegree, 37, 0}, kPeriod * i, i);
    const Expected<MotionEstimate> told = step.estimate(&memory),
                                   untold = step.estimate(&memory_of_untold, false);
    ASSERT_TRUE(told && untold);
    if (i < 3) continue;
    EXPECT_FALSE(told->of_shake.isZero(0)) << i;
    EXPECT_FALSE(untold->of_shake.isZero(0)) << i;
  }
  ShakeMemory of_noise;
  for (int i = 0; i < 60; ++i) {
    const Expected<MotionEstimate> found = ShakenStep(Vibration(), kPeriod * i, i).estimate(&of_noise, false);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->of_shake.isZero(0)) << i;
  }
}

// As a rig that has turned makes it. The normal is believed to 0.006 degrees.
TEST(RowShake, IsNotFoundInAWrongNormalWhereTheShutterIsTakenAsGlobal) {
  ShakeMemory of_rolling, of_global;
  int found_by_rolling = 0;
  for (int i = 0; i < 60; ++i) {
    const ShakenStep step(Vibration(), kPeriod * i, i);
    const Eigen::Vector3d wrong = (step.truth.n + Eigen::Vector3d(0, 0, 0.03)).normalized();
    const Expected<MotionEstimate> rolling = step.estimate(&of_rolling, true, wrong),
                                   global = step.estimate(&of_global, false, wrong);
    ASSERT_TRUE(rolling && global);
    found_by_rolling += !rolling->of_shake.isZero(0);
    EXPECT_TRUE(global->of_shake.isZero(0)) << i;
  }
  EXPECT_GT(found_by_rolling, 0) << "it must look like shake";
}

TEST(RowShake, IsNotFoundInNoise) {
  ShakeMemory memory;
  for (int i = 0; i < 60; ++i) {
    const ShakenStep step(Vibration(), kPeriod * i, i);
    const Expected<MotionEstimate> with = step.estimate(&memory), without = step.estimate(nullptr);
    ASSERT_TRUE(with && without);
    EXPECT_TRUE(with->of_shake.isZero(0));
    EXPECT_EQ(with->motion.t, without->motion.t) << "nothing may change";
    EXPECT_EQ(with->covariance, without->covariance);
  }
}

// The residuals tell the size of the errors, so claims that are all too small by one factor change nothing.
TEST(RowShake, IsTheSameWhereMatchesClaimTooLittle) {
  ShakeMemory memory, memory_of_bold;
  bool found = false;
  for (int i = 0; i < 20; ++i) {
    const ShakenStep step({0.05 * kDegree, 37, 0}, kPeriod * i, i);
    ShakenStep bold = step;
    for (TemporalMatch& match : bold.matches) match.covariance /= 25;
    const Expected<MotionEstimate> usual = step.estimate(&memory), of_bold = bold.estimate(&memory_of_bold);
    ASSERT_TRUE(usual && of_bold);
    found = !usual->of_shake.isZero(0);
    const auto same = [](const auto& a, const auto& b) { return (a - b).norm() <= 1e-3 * a.norm(); };
    EXPECT_TRUE(same(usual->motion.t, of_bold->motion.t)) << i;
    EXPECT_TRUE(same(usual->covariance, of_bold->covariance)) << i;
    EXPECT_TRUE(same(usual->of_shake, of_bold->of_shake)) << i;
  }
  EXPECT_TRUE(found);
}

// Matches that agree better than they claim are trusted more, so the shake is told nearly as well.
TEST(RowShake, IsNearlyTheSameWhereMatchesClaimTooMuch) {
  ShakeMemory memory, memory_of_timid;
  for (int i = 0; i < 20; ++i) {
    const ShakenStep step({0.05 * kDegree, 37, 0}, kPeriod * i, i);
    ShakenStep timid = step;
    for (TemporalMatch& match : timid.matches) match.covariance *= 9;
    const Expected<MotionEstimate> usual = step.estimate(&memory),
                                   of_timid = timid.estimate(&memory_of_timid);
    ASSERT_TRUE(usual && of_timid) << i;
    if (i < 3) continue;
    EXPECT_LT((usual->motion.t - of_timid->motion.t).norm(), 0.03 * usual->motion.t.norm()) << i;
    EXPECT_LT((usual->covariance - of_timid->covariance).norm(), 0.5 * usual->covariance.norm()) << i;
  }
}

TEST(RowShake, IsForgottenWhenItEnds) {
  ShakeMemory memory;
  const auto isFound = [&](double amplitude, int first, int end) {
    bool found = false;
    for (int i = first; i < end; ++i) {
      const ShakenStep step({amplitude, 37, 0}, kPeriod * i, i);
      const Expected<MotionEstimate> estimate = step.estimate(&memory);
      found = estimate && !estimate->of_shake.isZero(0);
    }
    return found;
  };
  EXPECT_TRUE(isFound(0.05 * kDegree, 0, 20));
  EXPECT_FALSE(isFound(0, 20, 120));
}

// A quiet second before vibration must not delay what tells of it.
TEST(RowShake, IsFoundAtOnceAfterQuietPairs) {
  ShakeMemory memory;
  bool found = false;
  for (int i = 0; i < 22; ++i) {
    const ShakenStep step({i < 20 ? 0 : 0.1 * kDegree, 37, 0}, kPeriod * i, i);
    const Expected<MotionEstimate> estimate = step.estimate(&memory);
    ASSERT_TRUE(estimate) << i;
    found = !estimate->of_shake.isZero(0);
    EXPECT_EQ(found, i >= 20) << i;
  }
}

// Vibration that begins is not yet certain at its first pair, but the motion claims it.
TEST(RowShake, IsClaimedBeforeItIsFound) {
  double squares = 0, squares_unwatched = 0;
  constexpr int kTries = 12;
  for (int i = 0; i < kTries; ++i) {
    const ShakenStep step({0.04 * kDegree, 37, 0.5 * i}, kPeriod * i, i);
    ShakeMemory memory;
    const Expected<MotionEstimate> estimate = step.estimate(&memory), unwatched = step.estimate(nullptr);
    ASSERT_TRUE(estimate && unwatched) << i;
    if (!estimate->of_shake.isZero(0)) continue;
    squares += std::pow(step.ratio(*estimate), 2) / kTries;
    squares_unwatched += std::pow(step.ratio(*unwatched), 2) / kTries;
  }
  EXPECT_LT(std::sqrt(squares), 2.5);
  EXPECT_GT(std::sqrt(squares_unwatched), 5) << "the vibration must matter";
}

// The camera turns faster than it was thought to while its rows are exposed.
TEST(RowTurn, ThatNothingAccountsForIsClaimed) {
  const Eigen::Vector3d rate = Eigen::Vector3d(1, 0.5, -2) * kDegree;  // rad/s
  double squares = 0, squares_without = 0;
  constexpr int kSteps = 20;
  for (int i = 0; i < kSteps; ++i) {
    ShakenStep step(Vibration(), kPeriod * i, i);
    for (TemporalMatch& match : step.matches) {
      const Eigen::Vector3d turn = kReadout * unitTimes().at(match.now.x(), match.now.y()) * rate;
      match.now = motionRig().project(motionRig().ray(match.now.x(), match.now.y()) +
                                      turn.cross(motionRig().ray(match.now.x(), match.now.y())));
    }
    const auto squareOf = [&](double claimed) {
      RowDoubt doubt;
      ShakeMemory memory;
      doubt.shake = {&unitTimes(), &memory};
      doubt.turn = claimed * claimed * kReadout * kReadout * Eigen::Matrix3d::Identity();
      MotionMemory work;
      const Expected<MotionEstimate> found = estimateMotion(motionRig(), step.matches,
                                                            {{step.truth.movement.R, step.truth.t},
                                                             {step.truth.n, test::across(step.truth.n, 1e-4)},
                                                             nullptr,
                                                             doubt},
                                                            20, work);
      return found ? std::pow(step.ratio(*found), 2) : 1e9;
    };
    squares += squareOf(rate.norm()) / kSteps;
    squares_without += squareOf(0) / kSteps;
  }
  EXPECT_LT(std::sqrt(squares), 2);
  EXPECT_GT(std::sqrt(squares_without), 3) << "the turn must matter";
}

}  // namespace
}  // namespace uav_landing
