#include "landing/watch/sink_rate_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kStep;

constexpr double kSpeed = 20;  // m/s

/// A level camera 20 m/s fast. The vertical speed is known to 3 m/s by the heights alone, so that the motion
/// tells it.
class Flight {
 public:
  MotionDoubt doubt;
  HeightErrors errors;
  bool motion_known = true;
  double turned = 0;                   // the plane against level, rad
  PairTests before = test::noTests();  // of this pair, made before
  PairTests tests = before;            // and with the watch's

  /// To this height, while the motion shows this sink rate.
  Failure fly(double height, double sink) { return watch(height, sink, test::filterAt(height, 0.01, 0, 3)); }
  /// Without a height, as the track is lost.
  Failure flyLost() { return watch(10, 0, test::emptyFilter()); }
  /// Level flight at 10 m until a height is compared with those before.
  void settle() {
    for (int i = 0; i < 12; ++i) {
      EXPECT_FALSE(fly(10, 0)) << i;
    }
    ASSERT_TRUE(possible());
  }
  /// Whether heights pass for two seconds that sink by so many metres a second, from 10 m on.
  bool passes(double sink, double sink_by_motion) {
    for (int i = 0; i <= 20; ++i)
      if (fly(10 - sink * kStep * i, sink_by_motion)) return false;
    return true;
  }
  bool possible() const { return tests.result(IntegrityTest::kSinkRate).possible(); }

 private:
  Failure watch(double height, double sink, const HeightFilter& filter) {
    const StereoDepthResult stereo = test::stereoAt(stamp_, height, turned, 0);
    ApproachAngleResult approach = test::withoutTurning(stamp_);
    approach.step.translation_over_height = kStep * Eigen::Vector3d(0, sink, kSpeed) / height;
    if (!motion_known) approach.step.failure = {Reason::kMotionInconsistent, ""};
    stamp_ += kStep;
    tests = before;
    return watch_.check(test::pairOf(stereo, approach), test::groundOf(stereo.plane), {filter, errors}, doubt,
                        tests);
  }

  SinkRateWatch watch_{KalmanHeightParameters()};
  double stamp_ = 0;
};

TEST(SinkRateWatch, ComparesWithAHeightOfHalfASecondAgo) {
  Flight flight;
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(flight.fly(10, 0));
    EXPECT_FALSE(flight.possible()) << i;
  }
  flight.fly(10, 0);
  flight.fly(10, 0);
  EXPECT_TRUE(flight.possible());
}

TEST(SinkRateWatch, AHeightThatLeapsWithoutTheMotionIsNotValid) {
  Flight flight;
  flight.settle();
  EXPECT_EQ(
      flight.fly(11, 0).message(),
      "inconsistent: sink_rate: the height differs by 1 m from the earlier height carried on by the motion");
  EXPECT_EQ(test::failedOf(flight.tests), "sink_rate");
  EXPECT_FALSE(flight.fly(10, 0)) << "the height remembered is the right one";
}

TEST(SinkRateWatch, AHeightHasToSinkAsTheMotionSays) {
  EXPECT_TRUE(Flight().passes(2, 2));
  EXPECT_FALSE(Flight().passes(2, 0));
  EXPECT_FALSE(Flight().passes(0, 2));
}

TEST(SinkRateWatch, ANormalThatIsDoubtedExcusesASinkRate) {
  Flight flight;
  flight.doubt.angle_variance = std::pow(0.15, 2);  // of 20 m/s: 3 m/s
  EXPECT_TRUE(flight.passes(2, 0));
}

TEST(SinkRateWatch, DurationsThatAreDoubtedExcuseASinkRateByAShareOfIt) {
  Flight sinking, level;
  sinking.doubt.duration_variance = level.doubt.duration_variance = 0.5 * 0.5;
  EXPECT_TRUE(sinking.passes(2, 4)) << "1 sigma is 2 m/s";
  EXPECT_FALSE(level.passes(2, 0)) << "half of nothing";
}

TEST(SinkRateWatch, WhatTheSurfaceIsWrongByExcusesALeap) {
  Flight flight;
  flight.errors.surface = 1;  // m^2
  flight.settle();
  EXPECT_FALSE(flight.fly(11, 0));
}

// The motion of a level flight sinks against a plane that is tilted.
TEST(SinkRateWatch, WhileTheNormalIsContradictedTheMotionDoesNotSayWhatIsDown) {
  Flight believed, contradicted;
  believed.turned = contradicted.turned = -0.1;
  contradicted.before = test::failing(IntegrityTest::kTilt);
  EXPECT_FALSE(believed.passes(0, 0));
  EXPECT_TRUE(contradicted.passes(0, 0));
}

TEST(SinkRateWatch, AnotherHeightAfterALossOfTrackIsNotBelieved) {
  Flight flight;
  flight.settle();
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(flight.flyLost()) << "nothing to compare";
  EXPECT_TRUE(flight.fly(14, 0));
  EXPECT_TRUE(flight.fly(14, 0));
  EXPECT_FALSE(flight.fly(10, 0));
}

TEST(SinkRateWatch, AHeightThatIsNotKnownWithoutMotionAnyMoreContradictsNothing) {
  Flight flight;
  flight.settle();
  flight.motion_known = false;
  for (int i = 0; i < 30; ++i) flight.flyLost();
  EXPECT_FALSE(flight.fly(14, 0));
  EXPECT_FALSE(flight.possible());
}

}  // namespace
}  // namespace uav_landing
