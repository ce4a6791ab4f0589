#include "landing/height/landing_clock.h"

#include <gtest/gtest.h>

#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::measuredHeight;
using test::pairOf;
using test::priorAt;
using test::withoutTurning;

constexpr double kTimeout = 1, kGate = 5;
constexpr double kPeriod = 0.05, kSpeed = 20;  // s, m/s

TEST(LandingClock, TellsTheTimeSinceThePairBefore) {
  LandingClock clock(kTimeout, kGate);
  const LandingClock::Time first = clock.follow(100);
  EXPECT_EQ(first.T, 0);
  EXPECT_FALSE(first.jump);
  EXPECT_NEAR(clock.follow(100.1).T, 0.1, 1e-9);
  EXPECT_NEAR(clock.follow(100.15).T, 0.05, 1e-9);
}

TEST(LandingClock, AStampThatGoesBackRepeatsOrIsLateByMoreThanTheTimeoutIsAJump) {
  for (const double off : {-5.0, 0.0, 1.5}) {
    LandingClock clock(kTimeout, kGate);
    clock.follow(100);
    const LandingClock::Time time = clock.follow(100 + off);
    EXPECT_EQ(time.jump.reason, Reason::kTimeJump) << off;
    EXPECT_EQ(time.T, 0) << off;
    const LandingClock::Time next = clock.follow(100 + off + 0.1);
    EXPECT_FALSE(next.jump) << "the time goes on from there";
    EXPECT_NEAR(next.T, 0.1, 1e-9);
  }
}

TEST(LandingClock, APauseAsLongAsTheTimeoutIsNoJump) {
  LandingClock clock(kTimeout, kGate);
  clock.follow(100);
  const LandingClock::Time time = clock.follow(100 + kTimeout);
  EXPECT_FALSE(time.jump);
  EXPECT_EQ(time.T, kTimeout);
}

TEST(LandingClock, SaysWhichWayTheStampWent) {
  LandingClock clock(kTimeout, kGate);
  clock.follow(100);
  EXPECT_EQ(clock.follow(95).jump.message(), "time_jump: the stamp went back by 5 s");
  EXPECT_EQ(clock.follow(97.5).jump.message(), "time_jump: the stamp went ahead by 2.5 s");
  EXPECT_EQ(clock.follow(97.5).jump.message(), "time_jump: the stamp is that of the pair before");
}

TEST(LandingClock, KnowsTheAgeOfTheLastPairUntilAReset) {
  LandingClock clock(kTimeout, kGate);
  EXPECT_FALSE(clock.since(100));
  clock.follow(100);
  EXPECT_NEAR(*clock.since(100.4), 0.4, 1e-9);
  clock.reset();
  EXPECT_FALSE(clock.since(100.4));
  EXPECT_FALSE(clock.follow(3).jump) << "stamps may start anywhere again";
}

/// A descent in which heights are known to 2 cm.
class Flight {
 public:
  LandingClock clock{kTimeout, kGate};
  double sink = 2;        // m/s
  double way_factor = 1;  // of the motion that the images show
  bool known = true;      // the pairs before had a height

  /// The camera flies for `flown` seconds, the stamps say `stamped`.
  Failure fly(double flown, double stamped) {
    HeightPrior prior = known ? priorAt(height_ - sink * stamped, 0.02, -sink) : test::noPrior();
    height_ -= sink * flown;
    return compare(stepOf(flown, stamped), measuredHeight(height_, 0.02), prior);
  }
  void flyRegularly(int steps = 6) {
    for (int i = 0; i < steps; ++i) {
      EXPECT_FALSE(fly(kPeriod, kPeriod)) << i;
    }
  }
  /// The left picture of the pair before once more.
  Failure repeat() {
    StereoDepthResult stereo = test::noStereo(stamp_ += kPeriod);
    stereo.left_repeated = true;
    return clock.compare(pairOf(stereo, test::angleAt(stamp_)), measuredHeight(height_), priorAt(height_));
  }
  Failure flyWithoutMotion() {
    return compare(test::angleAt(stamp_ += kPeriod), measuredHeight(height_), priorAt(height_));
  }
  Failure flyWithoutHeight() { return compare(stepOf(kPeriod, kPeriod), test::noHeight(), priorAt(height_)); }

 private:
  ApproachAngleResult stepOf(double flown, double stamped) {
    ApproachAngleResult approach = withoutTurning(stamp_ += stamped);
    approach.step.duration = stamped;
    approach.step.translation_over_height = {0, 0, way_factor * kSpeed * flown / height_};
    approach.step.covariance = 1e-8 * Matrix6d::Identity();
    return approach;
  }
  Failure compare(const ApproachAngleResult& approach, const MeasuredHeight& measured,
                  const HeightPrior& prior) {
    clock.follow(stamp_);
    return clock.compare(pairOf(approach), measured, prior);
  }

  double stamp_ = 100, height_ = 30;
};

TEST(LandingClock, NoticesThatTheClockWasSetByTheWayAndTheHeight) {
  Flight flight;
  flight.flyRegularly();
  EXPECT_EQ(
      flight.fly(kPeriod, kPeriod + 0.5).message(),
      "time_jump: the stamp went ahead by 0.55 s, the camera moved as far as in 0.05 s: the clock was set");
}

TEST(LandingClock, NoticesAtOnceThatItIsSetAgain) {
  Flight flight;
  flight.flyRegularly();
  EXPECT_TRUE(flight.fly(kPeriod, kPeriod + 0.5));
  EXPECT_TRUE(flight.fly(kPeriod, kPeriod + 0.5));
  EXPECT_FALSE(flight.fly(kPeriod, kPeriod));
}

TEST(LandingClock, ADroppedFrameIsNoClockThatWasSet) {
  Flight flight;
  flight.flyRegularly();
  EXPECT_FALSE(flight.fly(2 * kPeriod, 2 * kPeriod));
}

// Matches that are a period of a pattern too far tell another time, too.
TEST(LandingClock, AWayIsNotBelievedWhereTheHeightAgreesWithTheStamps) {
  Flight flight;
  flight.flyRegularly();
  flight.way_factor = 3;
  EXPECT_FALSE(flight.fly(kPeriod, kPeriod));
}

TEST(LandingClock, AWayIsNotBelievedWhereTheHeightCannotTell) {
  Flight level;
  level.sink = 0;
  level.flyRegularly();
  EXPECT_FALSE(level.fly(kPeriod, kPeriod + 0.5));
  Flight unknown;
  unknown.known = false;
  unknown.flyRegularly();
  EXPECT_FALSE(unknown.fly(kPeriod, kPeriod + 0.5));
}

TEST(LandingClock, ComparesTheWayOverARepeatedPictureWithTheTimeOfBoth) {
  Flight flight;
  flight.flyRegularly();
  EXPECT_FALSE(flight.repeat());
  EXPECT_TRUE(flight.fly(2 * kPeriod, 2 * kPeriod + 0.5));
}

TEST(LandingClock, AfterAPairWithoutMotionOrHeightStepsHaveToBeRegularFirst) {
  for (const bool motion : {false, true}) {
    Flight flight;
    flight.flyRegularly();
    EXPECT_FALSE(motion ? flight.flyWithoutHeight() : flight.flyWithoutMotion());
    EXPECT_FALSE(flight.fly(kPeriod, kPeriod + 0.5)) << motion;
    flight.flyRegularly();
    EXPECT_TRUE(flight.fly(kPeriod, kPeriod + 0.5)) << motion;
  }
}

TEST(LandingClock, AJumpOfTheStampsOrAResetForgetsTheSteps) {
  Flight jumped, was_reset;
  jumped.flyRegularly();
  jumped.clock.follow(1000);
  EXPECT_FALSE(jumped.fly(kPeriod, kPeriod + 0.5));
  was_reset.flyRegularly();
  was_reset.clock.reset();
  EXPECT_FALSE(was_reset.fly(kPeriod, kPeriod + 0.5));
}

}  // namespace
}  // namespace uav_landing
