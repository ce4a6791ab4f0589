// What wrong stamps do to a flight whose images are right: a clock that is set, that runs fast, that jitters.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "integrity/tests/stamp_order.h"
#include "support/rigs.h"
#include "uav_landing/parameters/rectify_parameters.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

constexpr double kPeriod = 0.05, kSpeed = 20, kSink = 2;  // s, m/s, m/s
constexpr double kPitch = -4 * M_PI / 180;
constexpr int kFrames = 200, kFirstWrong = 60;
constexpr double kHeightStddev = 0.02;  // m

/// What the stamp of a frame is late by, s. Random numbers are for those that jitter.
using Clock = std::function<double(int frame, std::mt19937& random)>;

struct Flown {
  std::vector<LandingResult> results;  // of the pairs that were used
  std::vector<double> heights;         // true, m
  std::vector<int> frames;
};

StereoDepthResult stereoAt(double stamp, double height, double noise) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  stereo.plane.g = down / (height + noise);
  // 1 sigma of the height along the normal, of the tilt 0.01 degrees.
  const double along = kHeightStddev / (height * height), across = 1.7e-4 / height;
  stereo.plane.covariance = along * along * down * down.transpose() +
                            across * across * (Eigen::Matrix3d::Identity() - down * down.transpose());
  return stereo;
}

/// The step from the frame `last` to the frame `now`, its duration by the stamps.
ApproachAngleResult motionBetween(int last, int now, double stamp, double duration) {
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  const double height = 30 - kSink * kPeriod * now;
  ApproachAngleResult approach;
  approach.stamp = stamp;
  approach.n = down;
  approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
  approach.step.duration = duration;
  approach.step.rotation.setZero();
  approach.step.translation_over_height = (now - last) * kPeriod * (kSpeed * forward + kSink * down) / height;
  approach.step.covariance = 1e-8 * Matrix6d::Identity();
  approach.step.angle = std::atan(kSink / kSpeed);
  approach.step.angle_variance = 1e-6;
  return approach;
}

Flown fly(const Clock& clock) {
  KalmanHeightStage stage(test::rigOf({640, 480}, 500, {320, 240}, 320, 1.0), {});
  StampOrder order(RectifyParameters().max_late);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  Flown flown;
  double last_stamp = 0;
  int last = 0;
  for (int i = 0; i < kFrames; ++i) {
    const double height = 30 - kSink * kPeriod * i, noise = kHeightStddev * normal(random);
    const double stamp = 100 + kPeriod * i + (i < kFirstWrong ? 0 : clock(i, random));
    if (!StampOrder::isUsed(order.follow(std::llround(1e9 * stamp)))) continue;
    ApproachAngleResult approach = motionBetween(last, i, stamp, stamp - last_stamp);
    // The motion's first frame, and one whose stamp is before the last: as approach_angle says it.
    if (i == 0 || stamp <= last_stamp) {
      approach.step = {};
      approach.step.failure = {Reason::kNotYet, "no earlier frame"};
    }
    flown.results.push_back(stage.process(stereoAt(stamp, height, noise), approach));
    flown.heights.push_back(height);
    flown.frames.push_back(i);
    last_stamp = stamp;
    last = i;
  }
  return flown;
}

/// Frames in a row without a valid height, at the most, from the first wrong stamp on.
int longestGap(const Flown& flown) {
  int longest = 0, last_valid = kFirstWrong - 1;
  for (size_t k = 0; k < flown.results.size(); ++k) {
    if (!flown.results[k].height_valid) continue;
    longest = std::max(longest, flown.frames[k] - last_valid - 1);
    last_valid = std::max(last_valid, flown.frames[k]);
  }
  return std::max(longest, kFrames - last_valid - 1);
}

void expectNoWrongHeight(const Flown& flown) {
  for (size_t k = 0; k < flown.results.size(); ++k) {
    const LandingResult& result = flown.results[k];
    if (result.height_valid) {
      EXPECT_NEAR(result.height, flown.heights[k], result.height_protection_level)
          << "frame " << flown.frames[k];
    }
  }
}

class ClockThatIsSet : public testing::TestWithParam<double> {};

TEST_P(ClockThatIsSet, IsFollowedWithinAThirdOfASecondAndNoHeightIsWrong) {
  const double step = GetParam();
  const Flown flown = fly([&](int, std::mt19937&) { return step; });
  expectNoWrongHeight(flown);
  EXPECT_LE(longestGap(flown), 6);
  const LandingResult& last = flown.results.back();
  EXPECT_TRUE(last.height_valid) << last.failure.message();
  EXPECT_NEAR(last.height, flown.heights.back(), 0.1);
}

TEST_P(ClockThatIsSet, IsFollowedTwice) {
  const double step = GetParam();
  const Flown flown = fly([&](int i, std::mt19937&) { return i < kFirstWrong + 15 ? step : 2 * step; });
  expectNoWrongHeight(flown);
  EXPECT_LE(longestGap(flown), 8);
}

INSTANTIATE_TEST_SUITE_P(ByUpToASecond, ClockThatIsSet,
                         testing::Values(-0.9, -0.5, -0.31, -0.2, -0.1, -0.05, 0.05, 0.1, 0.2, 0.31, 0.5,
                                         0.9));

TEST(KalmanHeightClock, SaysThatTheClockWasSet) {
  const Flown flown = fly([](int, std::mt19937&) { return 0.5; });
  const LandingResult& jump = flown.results[kFirstWrong];
  EXPECT_FALSE(jump.height_valid);
  EXPECT_FALSE(jump.angle_valid);
  EXPECT_EQ(
      jump.failure.message(),
      "time_jump: the stamp went ahead by 0.55 s, the camera moved as far as in 0.05 s: the clock was set");
  EXPECT_EQ(jump.resets, 1);
}

TEST(KalmanHeightClock, AClockThatRunsFastOrSlowByFivePerCentCostsNoHeight) {
  for (const double rate : {-0.05, 0.05}) {
    const Flown flown = fly([&](int i, std::mt19937&) { return rate * kPeriod * (i - kFirstWrong + 1); });
    expectNoWrongHeight(flown);
    EXPECT_EQ(longestGap(flown), 0) << rate;
  }
}

TEST(KalmanHeightClock, ArrivalTimesInsteadOfExposureTimesGiveNoWrongHeight) {
  const Flown flown =
      fly([](int, std::mt19937& random) { return std::uniform_real_distribution<double>(0, 0.02)(random); });
  expectNoWrongHeight(flown);
  EXPECT_EQ(longestGap(flown), 0);
}

TEST(KalmanHeightClock, TwoClocksInTurnGiveNoWrongHeight) {
  for (const double apart : {0.02, 0.1, 0.2}) {
    const Flown flown = fly([&](int i, std::mt19937&) { return i % 2 == 0 ? apart : 0; });
    expectNoWrongHeight(flown);
    EXPECT_LE(longestGap(flown), 10) << apart;
  }
}

TEST(KalmanHeightClock, AFlightWithDroppedFramesIsFollowedWithoutAReset) {
  KalmanHeightStage stage(test::rigOf({640, 480}, 500, {320, 240}, 320, 1.0), {});
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  int last = 0;
  for (int i = 0; i < kFrames; i += std::uniform_int_distribution<int>(1, 4)(random)) {
    const double stamp = 100 + kPeriod * i;
    ApproachAngleResult approach = motionBetween(last, i, stamp, kPeriod * (i - last));
    if (i == 0) approach.step.failure = {Reason::kNotYet, "no earlier frame"};
    const LandingResult result =
        stage.process(stereoAt(stamp, 30 - kSink * kPeriod * i, kHeightStddev * normal(random)), approach);
    EXPECT_EQ(result.resets, 0);
    EXPECT_NE(result.failure.reason, Reason::kTimeJump) << i;
    last = i;
  }
}

}  // namespace
}  // namespace uav_landing
