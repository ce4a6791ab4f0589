#include "integrity/tests/runway_identity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/degree.h"

namespace uav_landing {
namespace {

using test::kDegree;

constexpr double kStep = 0.1;  // s

/// A camera that looks along a runway over level ground and does not turn.
struct Flight {
  RunwayIdentity identity;
  double stamp = 10;

  bool path_known = true;

  void see(const Eigen::Vector3d& direction, double margin) {
    ApproachAngleResult::Motion turn;
    turn.duration = kStep;
    turn.rotation.setZero();
    turn.covariance = std::pow(0.01 * kDegree, 2) * Matrix6d::Identity();
    stamp += kStep;
    const Eigen::Matrix3d covariance = std::pow(0.05 * kDegree, 2) * Eigen::Matrix3d::Identity();
    identity.follow(stamp, {{direction, covariance}, margin, path_known}, Eigen::Vector3d::UnitY(), turn);
  }
  void see(double aside_deg, double margin) {
    see({std::sin(aside_deg * kDegree), 0, std::cos(aside_deg * kDegree)}, margin);
  }
  void seeNothing() { see(Eigen::Vector3d::Constant(kUnknown), 0); }
  double doubt() const { return identity.otherProbability(); }
};

TEST(RunwayIdentity, IsNotKnownBeforeThreePairsAgree) {
  Flight flight;
  EXPECT_EQ(flight.doubt(), 1);
  flight.see(0, 9);
  EXPECT_EQ(flight.doubt(), 1);
  flight.see(0, 9);
  EXPECT_EQ(flight.doubt(), 1);
  flight.see(0, 9);
  EXPECT_NEAR(flight.doubt(), std::exp(-9), 1e-12);
}

TEST(RunwayIdentity, MarginsOfPairsAreAveragedAsTheySeeTheSameLines) {
  Flight flight;
  for (int i = 0; i < 3; ++i) flight.see(0, i == 1 ? 12 : 3);
  EXPECT_NEAR(std::log(flight.doubt()), -6, 1e-9);
  for (int i = 0; i < 100; ++i) flight.see(0, 4);
  EXPECT_NEAR(std::log(flight.doubt()), -4, 1e-3) << "no more certain than each of them";
}

TEST(RunwayIdentity, MarginsThatKnowNoPathCountUntilThePathIsKnown) {
  Flight flight;
  flight.path_known = false;
  for (int i = 0; i < 3; ++i) flight.see(0, 15);
  EXPECT_NEAR(std::log(flight.doubt()), -15, 1e-9);
  flight.path_known = true;
  flight.see(0, 5);
  EXPECT_NEAR(std::log(flight.doubt()), -5, 1e-9) << "the path speaks against it";
  flight.see(0, 7);
  EXPECT_NEAR(std::log(flight.doubt()), -6, 1e-9);
  flight.path_known = false;
  flight.see(0, 9);
  EXPECT_NEAR(std::log(flight.doubt()), -7, 1e-9) << "a pair without its motion is one of many";
}

TEST(RunwayIdentity, ADirectionThatAnotherOutweighsIsCertainlyDoubtful) {
  Flight flight;
  for (int i = 0; i < 10; ++i) flight.see(0, -5);
  EXPECT_EQ(flight.doubt(), 1);
}

TEST(RunwayIdentity, TheCertaintyFadesWhileNoRunwayIsToldFromOtherLines) {
  Flight flight;
  for (int i = 0; i < 10; ++i) flight.see(0, 12);
  const double certain = flight.doubt();
  for (int i = 0; i < 10; ++i) flight.see(0, 0);
  // 1 s of 3.
  EXPECT_NEAR(std::log(flight.doubt()) / std::log(certain), std::exp(-1.0 / 3), 1e-6);
  for (int i = 0; i < 30; ++i) flight.see(0, 0);
  EXPECT_GT(flight.doubt(), 1e-3);
}

TEST(RunwayIdentity, ADirectionThatLeapsIsNotTheRunwaysAndHasToProveItself) {
  Flight flight;
  for (int i = 0; i < 10; ++i) flight.see(0, 12);
  flight.see(2, 20);
  EXPECT_EQ(flight.doubt(), 1);
  flight.see(0, 12);
  EXPECT_LT(flight.doubt(), 1e-4) << "the runway again";
  int pairs = 0;
  do {
    flight.see(2, 20);
    ++pairs;
  } while (flight.doubt() == 1 && pairs < 20);
  EXPECT_EQ(pairs, 6) << "three that are not believed, then three that agree";
  EXPECT_LT(flight.doubt(), 1e-6);
}

TEST(RunwayIdentity, WithoutADirectionThereIsNoneOfARunway) {
  Flight flight;
  for (int i = 0; i < 10; ++i) flight.see(0, 12);
  flight.seeNothing();
  EXPECT_EQ(flight.doubt(), 1);
  flight.see(0, 12);
  EXPECT_LT(flight.doubt(), 1e-4);
}

TEST(RunwayIdentity, IsForgottenAfterASecondWithoutPairs) {
  Flight flight;
  for (int i = 0; i < 10; ++i) flight.see(0, 12);
  flight.identity.skip(flight.stamp += 0.5);
  EXPECT_EQ(flight.doubt(), 1);
  flight.see(0, 12);
  EXPECT_LT(flight.doubt(), 1e-3) << "still the same";
  flight.stamp += 1.5;
  flight.see(0, 12);
  EXPECT_EQ(flight.doubt(), 1);
}

}  // namespace
}  // namespace uav_landing
