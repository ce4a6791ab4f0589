#include "landing/heading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/degree.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::kStep;

/// A camera over level ground that sees the runway's direction to its right.
class Flight {
 public:
  Heading heading;

  VanishingMemory::Direction fly(double aside_deg, bool repeated = false) {
    StereoDepthResult stereo = test::stereoAt(stamp_, 10, 0, 0);
    stereo.left_repeated = repeated;
    ApproachAngleResult approach = test::withoutTurning(stamp_);
    approach.vanishing_direction = {std::sin(aside_deg * kDegree), 0, std::cos(aside_deg * kDegree)};
    approach.vanishing_covariance = std::pow(0.03 * kDegree, 2) * Eigen::Matrix3d::Identity();
    stamp_ += kStep;
    return heading.follow(test::pairOf(stereo, approach), Eigen::Vector3d::UnitY());
  }
  VanishingMemory::Direction flyWithoutRunway() {
    const double stamp = stamp_;
    stamp_ += kStep;
    return heading.follow(test::pairOf(test::stereoAt(stamp, 10, 0, 0), test::withoutTurning(stamp)),
                          Eigen::Vector3d::UnitY());
  }

 private:
  double stamp_ = 0;
};

double asideDeg(const VanishingMemory::Direction& direction) {
  return std::atan2(direction.direction.x(), direction.direction.z()) / kDegree;
}

TEST(Heading, IsTheDirectionThatThePairSees) {
  Flight flight;
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(asideDeg(flight.fly(0.02 * (i % 2))), 0.02 * (i % 2), 1e-9) << i;
}

TEST(Heading, OneThatLeapsDoesNotCountAndTheOneBeforeIsLessCertainByTheTurn) {
  Flight flight;
  for (int i = 0; i < 6; ++i) flight.fly(0);
  const VanishingMemory::Direction held = flight.fly(0.7);
  EXPECT_NEAR(asideDeg(held), 0, 1e-9);
  // As certain as the pair before with a rotation known to 0.05 degrees.
  EXPECT_NEAR(std::sqrt(held.covariance(0, 0)), std::hypot(0.03, 0.05) * kDegree, 1e-3 * kDegree);
  EXPECT_NEAR(asideDeg(flight.fly(0.01)), 0.01, 1e-9) << "the runway again";
}

// What stays is the runway: the turn may have been wrong.
TEST(Heading, OneThatStaysIsBelievedOnTheThirdPair) {
  Flight flight;
  for (int i = 0; i < 6; ++i) flight.fly(0);
  for (const double expected : {0.0, 0.0, 0.7, 0.7, 0.7})
    EXPECT_NEAR(asideDeg(flight.fly(0.7)), expected, 1e-9);
}

TEST(Heading, LeapsWithARunwayInBetweenAreEachHeldForTwoPairs) {
  Flight flight;
  for (int i = 0; i < 6; ++i) flight.fly(0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(asideDeg(flight.fly(0.7)), 0, 1e-9) << i;
    EXPECT_NEAR(asideDeg(flight.fly(0.7)), 0, 1e-9) << i;
    EXPECT_NEAR(asideDeg(flight.fly(0)), 0, 1e-9) << i;
  }
}

TEST(Heading, APictureOnceMoreIsNoPair) {
  Flight flight;
  for (int i = 0; i < 6; ++i) flight.fly(0);
  flight.fly(0.7);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(asideDeg(flight.fly(0.7, true)), 0, 1e-9) << i;
  EXPECT_NEAR(asideDeg(flight.fly(0)), 0, 1e-9);
  EXPECT_NEAR(asideDeg(flight.fly(0, true)), 0, 1e-9);
}

TEST(Heading, IsNotKnownWhereThePairSeesNoRunway) {
  Flight flight;
  for (int i = 0; i < 6; ++i) flight.fly(0);
  EXPECT_FALSE(flight.flyWithoutRunway().direction.allFinite());
}

/// Of a pair that passed all tests, over level ground.
struct Yaw {
  StereoDepthResult stereo = test::stereoAt(0, 10, 0, 0);
  ApproachAngleResult approach = test::withoutTurning(0);
  PairVerdict pair{PairTests(0.001, 3)};

  explicit Yaw(double other_runway_probability) {
    approach.vanishing_direction = Eigen::Vector3d::UnitZ();
    approach.vanishing_covariance = std::pow(0.03 * kDegree, 2) * Eigen::Matrix3d::Identity();
    approach.other_runway_probability = other_runway_probability;
  }
  Failure failure() const { return yawFailure(test::pairOf(stereo, approach), pair); }
};

TEST(YawFailure, TheDirectionMayBeThatOfSomethingElseOnceInAThousandPairs) {
  EXPECT_FALSE(Yaw(0.0009).failure());
  const Failure failure = Yaw(0.0012).failure();
  EXPECT_EQ(failure.reason, Reason::kNoRunway);
  EXPECT_NE(failure.detail.find("0.0012"), std::string::npos) << failure.detail;
}

TEST(YawFailure, SaysWhyTheLinesMeetInNoPoint) {
  Yaw yaw(0);
  yaw.approach.vanishing_direction.setConstant(kUnknown);
  yaw.approach.left.failure = {Reason::kTooFewFeatures, "2 lines of at least 3"};
  EXPECT_EQ(yaw.failure().message(), "too_few_features: 2 lines of at least 3");
}

TEST(YawFailure, APairThatATestRefusesHasNoYaw) {
  Yaw yaw(0);
  yaw.pair.failure = {Reason::kInconsistent, "tilt"};
  EXPECT_EQ(yaw.failure().message(), "inconsistent: tilt");
}

TEST(YawFailure, NorHasAPictureThatRepeats) {
  Yaw yaw(0);
  yaw.stereo.left_repeated = true;
  EXPECT_EQ(yaw.failure().reason, Reason::kRejected);
}

}  // namespace
}  // namespace uav_landing
