#include "pairs_in_flight.h"

#include <gtest/gtest.h>

#include <future>
#include <thread>

using namespace uav_landing;
using std::chrono::milliseconds;

namespace {

constexpr milliseconds kNoTime{0};
constexpr std::chrono::seconds kDeadline{30};

TEST(PairsInFlight, NobodyIsBehindWhenNobodyListens) {
  const auto shared = PairsInFlight::of("nobody");
  for (int i = 0; i < 10; ++i) shared->handedOn(ros::Time(1 + i));
  EXPECT_TRUE(shared->waitUntilBelow(1, kNoTime));
}

TEST(PairsInFlight, TheSlowestStageCounts) {
  const auto shared = PairsInFlight::of("two");
  const auto fast = PairsInFlight::join("two"), slow = PairsInFlight::join("two");
  for (int i = 1; i <= 3; ++i) shared->handedOn(ros::Time(i));
  fast->finished(ros::Time(3));
  slow->finished(ros::Time(1));
  EXPECT_FALSE(shared->waitUntilBelow(2, kNoTime));
  EXPECT_TRUE(shared->waitUntilBelow(3, kNoTime));
}

TEST(PairsInFlight, FinishingWakesTheOneWhoWaits) {
  const auto shared = PairsInFlight::of("wait");
  const auto stage = PairsInFlight::join("wait");
  shared->handedOn(ros::Time(1));
  auto below = std::async(std::launch::async, [&] {
    const auto end = std::chrono::steady_clock::now() + kDeadline;
    // Less than the second after which a pair counts as lost.
    while (!shared->waitUntilBelow(1, milliseconds(50)))
      if (std::chrono::steady_clock::now() > end) return false;
    return true;
  });
  stage->finished(ros::Time(1));
  EXPECT_TRUE(below.get());
}

TEST(PairsInFlight, AStageThatLeavesHoldsNobodyUp) {
  const auto shared = PairsInFlight::of("leave");
  auto stage = PairsInFlight::join("leave");
  shared->handedOn(ros::Time(1));
  EXPECT_FALSE(shared->waitUntilBelow(1, kNoTime));
  stage.reset();
  EXPECT_TRUE(shared->waitUntilBelow(1, kNoTime));
}

TEST(PairsInFlight, APairThatNeverArrivesHoldsNobodyUpForLong) {
  const auto shared = PairsInFlight::of("lost");
  const auto stage = PairsInFlight::join("lost");
  shared->handedOn(ros::Time(1));
  bool below = false;
  const auto end = std::chrono::steady_clock::now() + kDeadline;
  while (!below && std::chrono::steady_clock::now() < end)
    below = shared->waitUntilBelow(1, milliseconds(50));
  EXPECT_TRUE(below);
}

TEST(PairsInFlight, AStageThatTakesItsTimeHasLostNothing) {
  const auto shared = PairsInFlight::of("slow");
  const auto stage = PairsInFlight::join("slow");
  for (int i = 1; i <= 6; ++i) shared->handedOn(ros::Time(i));
  // Each takes 0.4 s: the last ones have waited for longer than a second.
  for (int i = 1; i <= 3; ++i) {
    std::this_thread::sleep_for(milliseconds(400));
    stage->finished(ros::Time(i));
  }
  EXPECT_FALSE(shared->waitUntilBelow(3, kNoTime)) << "4, 5 and 6 wait";
  EXPECT_TRUE(shared->waitUntilBelow(4, kNoTime));
}

TEST(PairsInFlight, OtherRigsAreNotConcerned) {
  const auto shared = PairsInFlight::of("one rig");
  const auto stage = PairsInFlight::join("another rig");
  shared->handedOn(ros::Time(1));
  EXPECT_TRUE(shared->waitUntilBelow(1, kNoTime));
}

}  // namespace
