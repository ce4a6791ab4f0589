#include "landing/watch/yaw_failure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/degree.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kDegree;

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
