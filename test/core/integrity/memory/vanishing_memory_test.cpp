#include "integrity/memory/vanishing_memory.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "support/degree.h"

namespace uav_landing {
namespace {

using test::kDegree;

constexpr double kStep = 0.1;                            // s
constexpr double kStddev = 0.15 * kDegree;               // of a direction
const Eigen::Vector3d kDown = Eigen::Vector3d::UnitY();  // the ground's normal in a level camera

Eigen::Matrix3d turnOf(double pitch_deg) {
  return Eigen::AngleAxisd(pitch_deg * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

/// An aircraft that pitches by so much from pair to pair, and sees the end of a runway.
struct Flight {
  VanishingMemory memory;
  double stamp = 10, pitch = 0;  // s, deg

  ApproachAngleResult::Motion turn(double pitch_deg) const {
    ApproachAngleResult::Motion motion;
    motion.duration = kStep;
    motion.rotation = Eigen::Vector3d(pitch_deg * kDegree, 0, 0);
    motion.covariance.setIdentity();
    motion.covariance *= std::pow(0.01 * kDegree, 2);
    return motion;
  }
  /// Of a line that lies so many degrees above the runway's.
  bool see(double above_deg, const ApproachAngleResult::Motion& motion) {
    const Eigen::Matrix3d R = turnOf(pitch);
    const Eigen::Vector3d direction = R * turnOf(above_deg) * Eigen::Vector3d::UnitZ();
    stamp += kStep;
    return memory.leaps(stamp, {direction, kStddev * kStddev * Eigen::Matrix3d::Identity()}, R * kDown,
                        motion);
  }
  bool see(double above_deg, double pitch_by = 0) {
    pitch += pitch_by;
    return see(above_deg, turn(pitch_by));
  }
  void skip() {
    stamp += kStep;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(memory.leaps(stamp, {Eigen::Vector3d::Constant(nan), Eigen::Matrix3d::Constant(nan)}, kDown,
                              turn(0)));
  }
};

/// One that four pairs have seen.
Flight knownRunway() {
  Flight flight;
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(flight.see(0)) << i;
  return flight;
}

TEST(VanishingMemory, OtherLinesLeapAndTheRunwaysOwnDoesNot) {
  Flight flight = knownRunway();
  EXPECT_TRUE(flight.see(-4));
  EXPECT_FALSE(flight.see(0)) << "what leapt is not remembered";
  EXPECT_FALSE(flight.see(0.5)) << "noise of 2.4 sigma";
  EXPECT_TRUE(flight.see(2.0));
}

TEST(VanishingMemory, FollowsTheCamera) {
  Flight flight = knownRunway();
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(flight.see(0, 1.5)) << i;
  EXPECT_TRUE(flight.see(-4, 1.5));
  // Up to 5 degrees per second, 1 sigma, where no step tells the rotation, or it is of another time.
  ApproachAngleResult::Motion unknown = flight.turn(0);
  unknown.failure = {Reason::kTooFewMatches, ""};
  EXPECT_FALSE(flight.see(2, unknown));
  ApproachAngleResult::Motion other = flight.turn(0);
  other.duration = 2 * kStep;
  EXPECT_FALSE(flight.see(0, other));
}

TEST(VanishingMemory, ADirectionThatFewPairsHaveSeenIsNoMeasure) {
  Flight flight;
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(flight.see(0)) << i;
  EXPECT_FALSE(flight.see(-4)) << "two have agreed";
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(flight.see(-4)) << i;
  EXPECT_TRUE(flight.see(0)) << "three have";
}

TEST(VanishingMemory, IsCarriedOverPairsWithoutADirectionForASecond) {
  Flight flight = knownRunway();
  for (int i = 0; i < 8; ++i) flight.skip();
  EXPECT_TRUE(flight.see(-4));
  flight.skip();
  EXPECT_FALSE(flight.see(-4)) << "it was a turn that nobody saw, or the runway itself";
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(flight.see(-4)) << i;
  EXPECT_TRUE(flight.see(0));
}

TEST(VanishingMemory, CountsOnlyWhatIsAlongTheAxis) {
  const VanishingMemory::Direction aside{Eigen::AngleAxisd(4 * kDegree, kDown) * Eigen::Vector3d::UnitZ(),
                                         kStddev * kStddev * Eigen::Matrix3d::Identity()};
  for (const bool across : {false, true}) {
    Flight flight = knownRunway();
    flight.stamp += kStep;
    const Eigen::Vector3d axis = across ? Eigen::Vector3d::UnitX() : kDown;
    EXPECT_EQ(flight.memory.leaps(flight.stamp, aside, axis, flight.turn(0)), across);
  }
}

TEST(VanishingMemory, TellsWhereTheRunwayIsWhileOtherLinesAreSeen) {
  Flight flight = knownRunway();
  ASSERT_TRUE(flight.see(-4, 1.5));
  ASSERT_TRUE(flight.memory.remembered());
  EXPECT_LT((flight.memory.remembered()->direction - turnOf(1.5) * Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  const double variance = flight.memory.remembered()->covariance(1, 1);
  EXPECT_NEAR(variance, std::pow(kStddev, 2) + std::pow(0.01 * kDegree, 2), 1e-3 * variance);
}

TEST(VanishingMemory, ATurnThatNobodySawMakesTheDirectionAsUncertain) {
  Flight flight = knownRunway();
  ApproachAngleResult::Motion unknown = flight.turn(0);
  unknown.failure = {Reason::kTooFewMatches, ""};
  const Eigen::Matrix3d before = flight.memory.remembered()->covariance;
  ASSERT_TRUE(flight.see(-40, unknown)) << "more than any turn of that time";
  // 5 degrees per second for a tenth of a second.
  const Eigen::Matrix3d grown = flight.memory.remembered()->covariance - before;
  EXPECT_LT((grown - std::pow(0.5 * kDegree, 2) * Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace uav_landing
