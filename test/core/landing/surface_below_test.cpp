#include "landing/height/surface_below.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kStep;
using test::usualRig;

constexpr double kHeight = 10;

/// 20 m/s over level ground that is `lower` by so many metres than the plane of all points. The nearest
/// ground in view is 16 m ahead.
class Flight {
 public:
  double lower = 0.3;
  bool left_out = false;
  SurfaceBelow surface{usualRig(), 5};

  void fly(int pairs = 1) {
    for (int i = 0; i < pairs; ++i) follow(stereo(), along());
  }
  /// A step that seems to climb by so many metres.
  void climb(double metres) {
    ApproachAngleResult approach = along();
    approach.step.translation_over_height.y() -= metres / kHeight;
    follow(stereo(), approach);
  }
  /// A motion that failed, with a turn among its numbers.
  void fail() {
    ApproachAngleResult approach = along();
    approach.step.failure = {Reason::kMotionInconsistent, "3 of 300 matches agree"};
    approach.step.rotation.x() = -0.1;
    follow(stereo(), approach);
  }
  /// A pair that sees nothing.
  PairInput blind() {
    const PairInput in = test::pairOf(test::noStereo(stamp_), test::angleAt(stamp_));
    stamp_ += kStep;
    surface.follow(in, Ground(), test::noHeight(), left_out, track(kHeight));
    return in;
  }
  /// The picture of the pair before once more, from this height.
  void repeat(double height) {
    StereoDepthResult again = stereo();
    again.left_repeated = true;
    const PairInput in = test::pairOf(again, test::angleAt(stamp_));
    stamp_ += kStep;
    surface.follow(in, test::groundOf(again.plane), test::measuredHeight(height), true, track(height));
  }
  std::optional<GroundMemory::Below> below(double height = kHeight) const {
    return surface.below(height, normal());
  }
  static Eigen::Vector3d normal() { return test::stereoAt(0, kHeight).plane.normal(); }

 private:
  static TrackVerdict track(double height) { return test::trackingAt(test::filterAt(height)); }
  StereoDepthResult stereo() const {
    StereoDepthResult stereo = test::stereoAt(stamp_, kHeight);
    for (int v = 200; v < 480; v += 10) {
      for (int u = 10; u < 640; u += 20) {
        const double disparity = stereo.plane.disparity(usualRig(), u, v) / (1 + lower / kHeight);
        if (disparity > 2) stereo.points.push_back({double(u), double(v), disparity, 0.1, true});
      }
    }
    return stereo;
  }
  ApproachAngleResult along() const {
    ApproachAngleResult approach = test::withoutTurning(stamp_);
    const Eigen::Vector3d n = normal();
    approach.step.translation_over_height = 0.2 * (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
    return approach;
  }
  void follow(const StereoDepthResult& stereo, const ApproachAngleResult& approach) {
    surface.follow(test::pairOf(stereo, approach), test::groundOf(stereo.plane),
                   test::measuredHeight(kHeight), left_out, track(kHeight));
    stamp_ += kStep;
  }

  double stamp_ = 0;
};

TEST(SurfaceBelow, IsNotKnownWhereTheGroundNeverWasInView) {
  Flight flight;
  flight.fly(5);
  EXPECT_FALSE(flight.below());
}

TEST(SurfaceBelow, IsTheGroundThatWasAheadAndHasBeenFlownTo) {
  Flight flight;
  flight.fly(30);
  ASSERT_TRUE(flight.below());
  EXPECT_NEAR(flight.below()->height, kHeight + flight.lower, 0.02);
  EXPECT_LT(std::sqrt(flight.below()->variance), 0.2);
}

TEST(SurfaceBelow, IsStillThatOfBeforeWhereAnotherGroundBegins) {
  Flight flight;
  flight.fly(30);
  flight.lower = 0;
  flight.fly(4);
  EXPECT_NEAR(flight.below()->height, kHeight + 0.3, 0.02);
  flight.fly(12);
  EXPECT_NEAR(flight.below()->height, kHeight, 0.02) << "24 m further";
}

TEST(SurfaceBelow, IsAsFarAsThePublishedHeightWhereThatHasChangedSince) {
  Flight flight;
  flight.fly(30);
  flight.repeat(kHeight - 0.2);
  flight.repeat(kHeight - 0.4);
  EXPECT_NEAR(flight.below(kHeight - 0.4)->height, kHeight - 0.4 + flight.lower, 0.02);
}

TEST(SurfaceBelow, IsNotLearnedFromPairsThatAreLeftOut) {
  Flight flight;
  flight.left_out = true;
  flight.fly(30);
  EXPECT_FALSE(flight.below());
}

TEST(SurfaceBelow, APairThatSeesNothingForgetsNothing) {
  Flight flight;
  flight.fly(30);
  const PairInput in = flight.blind();
  const Eigen::Vector3d normal = flight.surface.normal(in, Ground()).value();
  EXPECT_NEAR((normal - Flight::normal()).norm(), 0, 1e-6) << "that of the pair before";
  ASSERT_TRUE(flight.surface.below(kHeight, normal));
  EXPECT_NEAR(flight.surface.below(kHeight, normal)->height, kHeight + flight.lower, 0.02);
}

TEST(SurfaceBelow, IsForgottenAfterManyPairsThatSeeNothing) {
  Flight flight;
  flight.fly(30);
  for (int i = 0; i < 5; ++i) flight.blind();
  EXPECT_FALSE(flight.below());
}

// 0.1 rad would be metres.
TEST(SurfaceBelow, TheTurnOfAMotionThatFailedDoesNotLiftTheGround) {
  Flight flight;
  flight.fly(30);
  flight.fail();
  for (int i = 0; i < 10; ++i) {
    flight.fly();
    ASSERT_TRUE(flight.below()) << i;
    EXPECT_NEAR(flight.below()->height, kHeight + flight.lower, 0.1) << i;
  }
}

TEST(SurfaceBelow, AStepThatClimbsUnlikeTheFlightDoesNotLowerTheGround) {
  Flight flight;
  flight.fly(30);
  flight.climb(1.2);
  flight.fly();
  EXPECT_NEAR(flight.below()->height, kHeight + flight.lower, 0.1);
}

TEST(SurfaceBelow, TheNormalIsByThePairWhereItHasOne) {
  SurfaceBelow surface(usualRig(), 5);
  const StereoDepthResult stereo = test::stereoAt(0, kHeight);
  ApproachAngleResult approach = test::withoutTurning(0);
  EXPECT_FALSE(surface.normal(test::pairOf(approach), Ground()));
  approach.n = normalFromPitchRoll(-0.2, 0);
  approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
  const PairInput in = test::pairOf(stereo, approach);
  EXPECT_EQ(surface.normal(in, test::groundOf(stereo.plane)), stereo.plane.normal());
  EXPECT_EQ(surface.normal(in, Ground()), approach.n) << "without a plane";
}

TEST(SurfaceBelow, TheNormalOfThePairBeforeTurnsWithTheCamera) {
  Flight flight;
  flight.fly(5);
  // Nose up by 1 degree: what is at rest turns downwards in the image.
  constexpr double kTurn = M_PI / 180;
  ApproachAngleResult approach = test::withoutTurning(5 * kStep);
  approach.step.rotation = {-kTurn, 0, 0};
  const PairInput in = test::pairOf(approach);
  flight.surface.follow(in, Ground(), test::noHeight(), false, test::trackingAt(test::filterAt(kHeight)));
  const Eigen::Vector3d before = Flight::normal(), now = flight.surface.normal(in, Ground()).value();
  EXPECT_NEAR(std::acos(now.dot(before)), kTurn * std::hypot(before.y(), before.z()), 1e-6);
  EXPECT_NEAR(pitchOf(now) - pitchOf(before), kTurn, 0.01 * kTurn);
}

}  // namespace
}  // namespace uav_landing
