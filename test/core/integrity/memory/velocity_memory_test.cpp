#include "integrity/memory/velocity_memory.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180, kT = 0.05;
// Chi-square of three that one in a hundred thousand exceeds: 5.1 sigma.
constexpr double kLimit = 25.9;
const Eigen::Vector3d kForward(0, 0, 20);  // m/s

VelocityMemory::Step stepOf(const Eigen::Vector3d& velocity, double duration = kT) {
  VelocityMemory::Step step;
  step.duration = duration;
  step.rotation.setIdentity();
  step.way = velocity * duration;
  step.covariance = std::pow(0.005, 2) * Eigen::Matrix3d::Identity();  // 0.1 m/s in 0.05 s
  return step;
}

/// Squared normalised difference; not a number where there is no test. Learns what agrees.
double fly(VelocityMemory& memory, const VelocityMemory::Step& step) {
  const auto innovation = memory.follow(step);
  const double ratio =
      innovation ? innovation->difference.dot(innovation->covariance.ldlt().solve(innovation->difference))
                 : std::nan("");
  memory.learn(step, !(ratio > kLimit));
  return ratio;
}

VelocityMemory known() {
  VelocityMemory memory;
  for (int i = 0; i < 20; ++i) fly(memory, stepOf(kForward));
  return memory;
}

TEST(VelocityMemory, AStepOfAPeriodTooLongOrToTheOtherCameraOrBackwardsContradicts) {
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1, 0, 0),
                                     Eigen::Vector3d(0, 0, -2.5), Eigen::Vector3d(0, 0.1, 0)}) {
    VelocityMemory memory = known();
    EXPECT_GT(memory.sinceContradiction(), 1e3);
    EXPECT_GT(fly(memory, stepOf(kForward + off / kT)), kLimit) << off.transpose();
    EXPECT_EQ(memory.sinceContradiction(), 0);
    EXPECT_LT(fly(memory, stepOf(kForward)), 1) << "the velocity is still the one before";
    EXPECT_NEAR(memory.sinceContradiction(), kT, 1e-9);
  }
}

TEST(VelocityMemory, OnlyStepsThatAgreeCountAfterAContradiction) {
  VelocityMemory memory = known();
  EXPECT_GT(memory.agreed(), 1e3);
  fly(memory, stepOf(1.4 * kForward));
  memory.skip(2);
  EXPECT_EQ(memory.agreed(), 0);
  for (int i = 0; i < 3; ++i) fly(memory, stepOf(kForward));
  EXPECT_NEAR(memory.agreed(), 3 * kT, 1e-9);
  fly(memory, stepOf(3 * kForward));
  EXPECT_EQ(memory.agreed(), 0);
}

TEST(VelocityMemory, WhatAnAircraftDoesIsNoContradiction) {
  constexpr double kGravity = 9.81;
  VelocityMemory memory = known();
  Eigen::Vector3d velocity = kForward;
  for (int i = 0; i < 40; ++i) {  // brakes, climbs, and is blown aside by 1 g for half a second each way
    velocity += kGravity * kT * (i % 20 < 10 ? 1 : -1) * Eigen::Vector3d(0.6, 0.5, -0.6).normalized();
    EXPECT_LT(fly(memory, stepOf(velocity)), kLimit) << i;
  }
}

TEST(VelocityMemory, TheVelocityIsCarriedAlongTheTurnOfTheCamera) {
  VelocityMemory memory = known(), without = known();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(5 * kDegree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  VelocityMemory::Step step = stepOf(turn * kForward);
  EXPECT_GT(fly(without, step), kLimit) << "1.7 m/s aside";
  step.rotation = turn;
  EXPECT_LT(fly(memory, step), 1e-6);
}

// The limit is 5.1 sigma of 1.8 m/s^2 that lasts.
TEST(VelocityMemory, ContradictsForAsLongAsTheAircraftCannotHaveBecomeSoFast) {
  for (const double more : {10.0, 40.0}) {
    VelocityMemory memory = known();
    double time = 0;
    while (fly(memory, stepOf(kForward + Eigen::Vector3d(0, 0, more))) > kLimit) time += kT;
    EXPECT_NEAR(time, more / (5.1 * 1.8), 0.15 * time) << more;
    EXPECT_LT(fly(memory, stepOf(kForward + Eigen::Vector3d(0, 0, more))), kLimit);
    EXPECT_GT(fly(memory, stepOf(kForward)), kLimit) << "the new velocity is the one known";
  }
}

TEST(VelocityMemory, OfTheFirstStepsThatContradictEachOtherNoneIsBelievedBeforeThreeAgree) {
  VelocityMemory memory;
  for (const double speed : {60, 20, 60, 20, 20, 20})
    EXPECT_TRUE(std::isnan(fly(memory, stepOf({0, 0, speed}))));
  EXPECT_LT(fly(memory, stepOf(kForward)), 1);
  EXPECT_GT(fly(memory, stepOf({0, 0, 60})), kLimit);
}

TEST(VelocityMemory, StampsThatAreKnownToBeWrongAndPairsWithoutMotionLeaveMoreOpen) {
  VelocityMemory memory = known();
  VelocityMemory::Step late = stepOf(1.4 * kForward);
  EXPECT_GT(fly(memory, late), kLimit);
  late.stamp_variance = 0.1;
  EXPECT_LT(fly(memory, late), kLimit);

  memory = known();
  memory.skip(1);
  EXPECT_LT(fly(memory, stepOf(kForward + Eigen::Vector3d(0, 0, 10))), kLimit) << "5 m/s are 1 sigma";
  memory = known();
  memory.skip(1);
  EXPECT_GT(fly(memory, stepOf(kForward + Eigen::Vector3d(0, 0, 40))), kLimit);
}

TEST(VelocityMemory, AStepThatContradictsDoesNotTurnTheVelocity) {
  VelocityMemory memory = known();
  VelocityMemory::Step wrong = stepOf({0, 0, 100});
  wrong.rotation = Eigen::AngleAxisd(80 * kDegree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_GT(fly(memory, wrong), kLimit);
  for (int i = 0; i < 5; ++i) EXPECT_LT(fly(memory, stepOf(kForward)), kLimit) << i;
}

/// Aircraft that fly as the filter takes them to: at 20 m/s with a random acceleration of 5 m/s^2, seen with
/// an error of 0.1 m/s forward and of 0.2 m/s across. Mean of the squared differences over what is claimed
/// of each axis, of the step after those that are known. missing: steps before it that tell nothing.
Eigen::Vector3d differencesOverClaims(int missing) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto draw = [&](double x, double y, double z) -> Eigen::Vector3d {
    return {x * normal(random), y * normal(random), z * normal(random)};
  };
  constexpr int kFlights = 3000, kKnown = 6;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero(), claimed = Eigen::Vector3d::Zero();
  for (int flight = 0; flight < kFlights; ++flight) {
    VelocityMemory memory;
    Eigen::Vector3d velocity = kForward;
    const auto next = [&] {
      velocity += draw(5 * kT, 5 * kT, 5 * kT);
      VelocityMemory::Step step = stepOf(velocity + draw(0.2, 0.2, 0.1));
      step.covariance.diagonal() = Eigen::Vector3d(0.2 * kT, 0.2 * kT, 0.1 * kT).cwiseAbs2();
      return step;
    };
    for (int i = 0; i < kKnown; ++i) {
      const VelocityMemory::Step step = next();
      memory.follow(step);
      memory.learn(step, true);
    }
    for (int i = 0; i < missing; ++i) {
      velocity += draw(5 * kT, 5 * kT, 5 * kT);
      // The camera turns as well: what it sees of the velocity goes round.
      const Eigen::Vector3d turn = draw(5 * kDegree * kT, 5 * kDegree * kT, 5 * kDegree * kT);
      velocity = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * velocity;
      memory.skip(kT);
    }
    const auto innovation = memory.follow(next());
    if (!innovation) continue;  // three in a row that agree come later by chance
    squares += innovation->difference.cwiseAbs2();
    claimed += innovation->covariance.diagonal();
  }
  return squares.cwiseQuotient(claimed);
}

TEST(VelocityMemory, DifferencesAreAsLargeAsTheyAreClaimedToBe) {
  for (const int missing : {0, 10}) {
    const Eigen::Vector3d ratio = differencesOverClaims(missing);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(ratio[axis], 1, 0.1) << axis << ", " << missing;
  }
}

}  // namespace
}  // namespace uav_landing
