#include "rig/rig_change.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "integrity/tests/pair_tests.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

RigRotation rotation(double rx_deg, double rz_deg) {
  RigRotation result;
  result.w = Eigen::Vector3d(rx_deg, 0, rz_deg) * kDegree;
  result.covariance = std::pow(0.005 * kDegree, 2) * Eigen::Matrix3d::Identity();
  return result;
}

bool isLarge(const RigChange& change, const RigRotation& measured) {
  const auto innovation = change.compare(measured);
  return innovation && innovation->isLarge();
}

TEST(RigChange, SeesASuddenBendButNotAConstantError) {
  RigChange change;
  const auto failed = [&](const RigRotation& measured) {
    PairTests tests(1e-5, 5);
    const auto innovation = change.compare(measured);
    if (innovation) tests.add(IntegrityTest::kRigRotation, innovation->difference, innovation->covariance);
    const bool result = tests.failed(IntegrityTest::kRigRotation);
    change.learn(0.05, measured, !result);
    return result;
  };
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(failed(rotation(0.1, -0.05 + 0.003 * std::sin(i))));
  EXPECT_TRUE(failed(rotation(0.1, 0.02)));
  EXPECT_FALSE(failed(rotation(0.1, -0.05)));
}

TEST(RigChange, AnotherRotationIsTheRigsOnceItStaysTheSameForASecond) {
  RigChange change;
  const auto learn = [&](const RigRotation& measured) {
    const auto innovation = change.compare(measured);
    const bool agrees = !innovation || innovation->difference.norm() < 0.03 * kDegree;
    change.learn(0.05, measured, agrees);
  };
  for (int i = 0; i < 40; ++i) learn(rotation(0.1, 0));
  EXPECT_TRUE(change.settled());
  // Images that do not belong together: it changes all the time.
  double settled = 0;
  for (int i = 0; i < 400; ++i) {
    learn(rotation(0.1, 0.2 + 0.01 * (i % 37)));
    if (i > 70) settled += change.settled();
  }
  EXPECT_EQ(settled, 0);
  // A bend: for long it contradicts, then it must stay.
  double waited = 0;
  for (; !change.settled() && waited < 10; waited += 0.05) learn(rotation(0.1, 0.2));
  EXPECT_GE(waited, 1 - 1e-6);
  EXPECT_LT(waited, 2.1);
}

TEST(RigChange, ASmallBendIsTheRigsAfterASecondAndALargeOneAfterFour) {
  const auto secondsUntilKnown = [](double bend_deg) {
    RigChange change;
    const auto learn = [&](const RigRotation& measured) {
      const auto innovation = change.compare(measured);
      const bool agrees = !innovation || innovation->difference.norm() < 0.03 * kDegree;
      change.learn(0.05, measured, agrees);
      return agrees && change.settled();
    };
    for (int i = 0; i < 40; ++i) learn(rotation(0.1, 0));
    double waited = 0;
    while (!learn(rotation(0.1 + bend_deg, 0)) && waited < 10) waited += 0.05;
    return waited;
  };
  EXPECT_NEAR(secondsUntilKnown(0.05), 1, 0.11);
  EXPECT_NEAR(secondsUntilKnown(0.2), 4, 0.11);
  EXPECT_NEAR(secondsUntilKnown(1), 4, 0.11);
}

TEST(RigChange, DoubtsALargeBendUntilItHasStayedForASecond) {
  RigChange change;
  EXPECT_FALSE(change.doubts(rotation(1, 0))) << "nothing is known before";
  for (int i = 0; i < 40; ++i) change.learn(0.05, rotation(0, 0), true);
  EXPECT_FALSE(change.doubts(rotation(0.05, 0)));
  EXPECT_FALSE(change.doubts({})) << "not measured";
  double waited = 0;
  for (; change.doubts(rotation(0, -0.3)) && waited < 10; waited += 0.05)
    change.learn(0.05, rotation(0, -0.3), false);
  EXPECT_NEAR(waited, 1, 0.06);
}

TEST(RigChange, DoubtsAWildPairAlsoWhereAnotherOneHasStayedForASecond) {
  RigChange change;
  for (int i = 0; i < 40; ++i) change.learn(0.05, rotation(0, 0), true);
  for (int i = 0; i < 25; ++i) change.learn(0.05, rotation(0, 0.3), false);
  EXPECT_FALSE(change.doubts(rotation(0, 0.3)));
  EXPECT_TRUE(change.doubts(rotation(0, 5)));
}

TEST(RigChange, AFirstPairAfterALongGapHasNotStayed) {
  RigChange change;
  for (int i = 0; i < 40; ++i) change.learn(0.05, rotation(0, 0), true);
  change.learn(1.0, rotation(0, 5), false);
  EXPECT_TRUE(change.doubts(rotation(0, 5)));
  EXPECT_TRUE(change.doubts(rotation(0, -3)));
}

TEST(RigChange, BelievesNothingWhileItChangesAllTheTimeHoweverLong) {
  RigChange change;
  for (int i = 0; i < 40; ++i) change.learn(0.05, rotation(0, 0), true);
  int believed = 0;
  for (int i = 0; i < 200; ++i) {
    const RigRotation measured = rotation(0, 0.5 + 0.3 * std::sin(1.3 * i));
    believed += !change.doubts(measured);
    change.learn(0.05, measured, !isLarge(change, measured));
  }
  EXPECT_EQ(believed, 0);
}

TEST(RigChange, SaysOnceThatAnotherRotationIsTheRigs) {
  RigChange change;
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(change.learn(0.05, rotation(0, 0), true));
  int told = 0;
  for (int i = 0; i < 200; ++i) {
    const RigRotation measured = rotation(0.1, -0.3);
    if (!change.learn(0.05, measured, !isLarge(change, measured))) continue;
    ++told;
    EXPECT_NEAR(change.mean().w.x(), 0.1 * kDegree, 1e-9);
    EXPECT_NEAR(change.mean().w.z(), -0.3 * kDegree, 1e-9);
    EXPECT_TRUE(change.settled());
  }
  EXPECT_EQ(told, 1);
}

TEST(RigChange, DoubtsNothingThatIsOffByTheNoiseOfAllPairs) {
  const auto noisy = [](double rz_deg) {
    RigRotation measured = rotation(0, rz_deg);
    measured.covariance = std::pow(0.2 * kDegree, 2) * Eigen::Matrix3d::Identity();
    return measured;
  };
  RigChange change;
  for (int i = 0; i < 40; ++i) change.learn(0.05, noisy(0), true);
  EXPECT_FALSE(change.doubts(noisy(0.3)));
  EXPECT_TRUE(change.doubts(noisy(2)));
}

TEST(RigChange, ASmallRotationThatChangesIsNotTheRigs) {
  RigChange change;
  for (int i = 0; i < 40; ++i) change.learn(0.05, rotation(0, 0), true);
  // As of a picture that stands still while the camera moves on slowly.
  for (int i = 0; i < 50; ++i) {
    change.learn(0.05, rotation(0, 0.02 + 0.06 * (i % 2)), false);
    EXPECT_LT(change.compare(rotation(0, 0))->difference.norm(), 0.001 * kDegree) << i;
  }
}

TEST(RigChange, APairThatLooksExactByChanceIsNotMoreSoThanThePairsBefore) {
  RigChange change;
  const auto withStddev = [](double rz_deg, double stddev_deg) {
    RigRotation measured = rotation(0, rz_deg);
    measured.covariance = std::pow(stddev_deg * kDegree, 2) * Eigen::Matrix3d::Identity();
    return measured;
  };
  for (int i = 0; i < 40; ++i) change.learn(0.05, withStddev(0, 0.02), true);
  const auto stddev = [&](double of_pair) {
    return std::sqrt(change.compare(withStddev(0.12, of_pair))->covariance(1, 1)) / kDegree;
  };
  // With the floor of 0.004 deg on either side.
  const double before = std::hypot(0.02, 0.004);
  EXPECT_NEAR(stddev(0.001), std::hypot(before, before), 1e-6);
  EXPECT_NEAR(stddev(0.03), std::hypot(before, std::hypot(0.03, 0.004)), 1e-6);
  EXPECT_NEAR(stddev(0.5), std::hypot(before, 2 * before), 1e-6);
}

}  // namespace
}  // namespace uav_landing
