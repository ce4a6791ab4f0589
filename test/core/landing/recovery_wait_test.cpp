#include "landing/watch/recovery_wait.h"

#include <gtest/gtest.h>

#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::failing;
using test::filterAt;
using test::kStep;
using test::noTests;

/// Pairs one after the other. Each returns why the height is still waited for.
class Pairs {
 public:
  explicit Pairs(double recovery_time = 1) : wait_(parametersWith(recovery_time)) {}

  Failure agree(double T = kStep) { return follow(T, pairOf(), noTests(), trackingAt()); }
  /// Passes, but not as long as others failed.
  Failure confirm() {
    PairVerdict pair = leftOut();
    pair.confirming = true;
    return follow(kStep, pair, noTests(), coasting());
  }
  /// A pair that measures nothing.
  Failure miss() { return follow(kStep, pairOf(), noTests(), coasting()); }
  Failure contradict() { return follow(kStep, leftOut(), noTests(), coasting()); }
  /// The same after so long that the height is not valid any more.
  Failure contradictTooLong() {
    TrackVerdict post = coasting();
    post.outdated = true;
    return follow(kStep, leftOut(), noTests(), post);
  }
  Failure contradictFirstHeight() {
    TrackVerdict post = trackingAt();
    post.rejection = {Reason::kRejected, ""};
    post.confirmed = false;
    return follow(kStep, pairOf(), noTests(), post);
  }
  Failure agreeBut(IntegrityTest failed) { return follow(kStep, pairOf(), failing(failed), trackingAt()); }

  /// Pairs that agree until the height is believed.
  int untilBelieved() {
    int pairs = 1;
    while (agree() && pairs < 100) ++pairs;
    return pairs;
  }

 private:
  static KalmanHeightParameters parametersWith(double recovery_time) {
    KalmanHeightParameters parameters;
    parameters.recovery_time = recovery_time;
    return parameters;
  }
  static PairVerdict pairOf() { return PairVerdict(noTests()); }
  static PairVerdict leftOut() {
    PairVerdict pair = pairOf();
    pair.failure = {Reason::kInconsistent, "row_agreement"};
    return pair;
  }
  static TrackVerdict trackingAt() { return test::trackingAt(filterAt(10)); }
  static TrackVerdict coasting() {
    TrackVerdict post = trackingAt();
    post.status = Status::kCoasting;
    return post;
  }
  Failure follow(double T, const PairVerdict& pair, const PairTests& tests, const TrackVerdict& post) {
    return wait_.follow(T, pair, tests, post);
  }

  RecoveryWait wait_;
};

TEST(RecoveryWait, DoesNotWaitBeforeAnythingIsContradicted) {
  Pairs pairs;
  EXPECT_FALSE(pairs.miss());
  EXPECT_FALSE(pairs.agree());
}

TEST(RecoveryWait, AContradictionThatLeavesTheHeightValidIsNotWaitedFor) {
  Pairs pairs;
  EXPECT_FALSE(pairs.contradict());
  EXPECT_FALSE(pairs.agree());
}

TEST(RecoveryWait, AHeightThatWasLostIsBelievedAfterASecondThatAgrees) {
  Pairs pairs;
  EXPECT_TRUE(pairs.contradictTooLong());
  EXPECT_EQ(pairs.untilBelieved(), 10);
  EXPECT_FALSE(pairs.contradict()) << "and from then on as if nothing had been";
}

TEST(RecoveryWait, SaysForHowLongNothingHasContradicted) {
  Pairs pairs;
  pairs.contradictTooLong();
  for (int i = 0; i < 3; ++i) pairs.agree();
  EXPECT_EQ(pairs.agree().message(),
            "inconsistent: recovering: the tests have passed for 0.4 s, 1 s required");
}

TEST(RecoveryWait, AContradictionBeginsTheSecondAnew) {
  Pairs pairs;
  pairs.contradictTooLong();
  for (int i = 0; i < 9; ++i) EXPECT_TRUE(pairs.agree()) << i;
  EXPECT_TRUE(pairs.contradict());
  EXPECT_EQ(pairs.untilBelieved(), 10);
}

TEST(RecoveryWait, PairsThatMeasureNothingDoNotCount) {
  Pairs pairs;
  pairs.contradictTooLong();
  for (int i = 0; i < 30; ++i) EXPECT_TRUE(pairs.miss()) << i;
  EXPECT_EQ(pairs.untilBelieved(), 10);
}

TEST(RecoveryWait, PairsThatPassButAreStillLeftOutCount) {
  Pairs pairs;
  pairs.contradictTooLong();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(pairs.confirm()) << i;
  EXPECT_EQ(pairs.untilBelieved(), 7);
}

TEST(RecoveryWait, PairsThatTheVanishingPointContradictsDoNotCount) {
  Pairs pairs;
  EXPECT_FALSE(pairs.agreeBut(IntegrityTest::kVanishingPoint)) << "alone it is left out";
  pairs.contradictTooLong();
  for (int i = 0; i < 30; ++i) EXPECT_TRUE(pairs.agreeBut(IntegrityTest::kVanishingPoint)) << i;
  EXPECT_EQ(pairs.untilBelieved(), 10);
}

TEST(RecoveryWait, AHeightThatDoesNotFollowTheMotionIsWaitedFor) {
  Pairs pairs;
  EXPECT_TRUE(pairs.agreeBut(IntegrityTest::kSinkRate));
  EXPECT_EQ(pairs.untilBelieved(), 10);
}

TEST(RecoveryWait, FirstHeightsThatContradictEachOtherAreWaitedFor) {
  Pairs pairs;
  EXPECT_TRUE(pairs.contradictFirstHeight());
  EXPECT_EQ(pairs.untilBelieved(), 10);
}

TEST(RecoveryWait, APauseCountsForNoLongerThanAHeightLasts) {
  Pairs pairs;
  pairs.contradictTooLong();
  EXPECT_TRUE(pairs.agree(0.9)) << "0.3 s of it";
  EXPECT_EQ(pairs.untilBelieved(), 7);
}

TEST(RecoveryWait, WithoutARecoveryTimeNothingIsWaitedFor) {
  Pairs pairs(0);
  EXPECT_FALSE(pairs.contradictTooLong());
  EXPECT_FALSE(pairs.agree());
}

}  // namespace
}  // namespace uav_landing
