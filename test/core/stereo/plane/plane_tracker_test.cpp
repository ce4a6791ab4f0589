#include "stereo/plane/plane_tracker.h"

#include <gtest/gtest.h>

#include <memory>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;

constexpr int kPoints = 100;

/// Pairs of one picture, of which anything may be said.
class Flight {
  RigModel model_ = test::makeModel(test::makeRig(320, 240, 0.65));
  StereoDepthParameters parameters_;
  MatchImage image_;
  StereoLevel level_;
  Timings timings_;
  std::unique_ptr<CornerMatcher> matcher_ = makeRowMatcher(parameters_);

 public:
  PlaneTracker tracker{model_.rig, parameters_, {0.5, 0.5, 20, 1.0}, 200, *matcher_};

  Flight() {
    const cv::Mat left = GroundRenderer(5).left(model_.rig, test::makePose(2, -10, 0));
    image_.assign(left);
    level_ = reduceLevel(model_, 1, parameters_.window_radius + 2);
    level_.left = level_.right = image_.fine;
  }

  /// A plane at this height, some of whose corners agree.
  void see(double stamp, double height, int agreeing = kPoints, bool from_search = false) {
    tracker.begin(stamp);
    if (!tracker.steadyPlane(timings_)) tracker.follow(level_, level_, 1, timings_);
    tracker.remember(result(height, agreeing, from_search), true);
  }
  void miss(double stamp) {
    tracker.begin(stamp);
    tracker.miss();
  }
  std::optional<PlaneVector> steady(double stamp) {
    tracker.begin(stamp);
    return tracker.steadyPlane(timings_);
  }
  StereoDepthResult result(double height, int agreeing = kPoints, bool from_search = false) const {
    StereoDepthResult result;
    result.plane.g = plane(height);
    result.corners = kPoints;
    result.from_search = from_search;
    for (int i = 0; i < kPoints; ++i) {
      StereoDepthResult::Point point;
      point.u = 10 + 3 * i;
      point.v = 130 + i;
      point.on_plane = i >= kPoints - agreeing;
      result.points.push_back(point);
    }
    return result;
  }
  /// Largest disparity of the points, pixels.
  double disparity(double height) const {
    return model_.rig.fb() * plane(height).dot(model_.rig.ray(0, 130 + kPoints - 1));
  }
  static Eigen::Vector3d plane(double height) { return test::makePose(height, -10, 0).down() / height; }
};

TEST(PlaneTracker, IsSteadyOncePlanesFollowEachOther) {
  Flight flight;
  EXPECT_FALSE(flight.steady(0));
  flight.see(0.1, 2, kPoints, true);
  EXPECT_FALSE(flight.steady(0.2)) << "one plane says nothing of the next";
  flight.see(0.3, 2);
  EXPECT_TRUE(flight.steady(0.4));
}

TEST(PlaneTracker, ExpectsThePlaneToMoveOnWithTheTime) {
  Flight flight;
  for (const double t : {1.0, 1.1, 1.2}) flight.see(t, 1 / (0.5 + 0.02 * t));
  const std::optional<PlaneVector> expected = flight.steady(1.33);
  ASSERT_TRUE(expected);
  const Eigen::Vector3d truth = test::makePose(1, -10, 0).down() * (0.5 + 0.02 * 1.33);
  EXPECT_LT((expected->vector() - truth).norm(), 1e-9);
}

TEST(PlaneTracker, IsNotSteadyWhileThePlaneMovesUnexpectedly) {
  Flight flight;
  for (const double t : {1.0, 1.1}) flight.see(t, 2);
  const double before = flight.disparity(2);
  double height = 2;
  while (flight.disparity(height) < before + 1.2) height -= 1e-3;
  flight.see(1.2, height);
  EXPECT_FALSE(flight.steady(1.3));
  flight.see(1.4, height);
  EXPECT_FALSE(flight.steady(1.5)) << "it was expected to move on";
  flight.see(1.6, height);
  EXPECT_TRUE(flight.steady(1.7));
}

TEST(PlaneTracker, IsNotSteadyWithoutTheMajorityOfCorners) {
  Flight flight;
  for (const double t : {1.0, 1.1, 1.2}) flight.see(t, 2, kPoints / 2 - 1);
  EXPECT_FALSE(flight.steady(1.3));
  flight.see(1.4, 2, kPoints / 2);
  EXPECT_TRUE(flight.steady(1.5));
}

TEST(PlaneTracker, IsNotSteadyAfterAGapOrAPairWithoutAPlane) {
  Flight flight;
  for (const double t : {1.0, 1.1}) flight.see(t, 2);
  EXPECT_FALSE(flight.steady(1.3)) << "a pair was lost";
  for (const double t : {2.0, 2.1, 2.2}) flight.see(t, 2);
  ASSERT_TRUE(flight.steady(2.3));
  flight.miss(2.4);
  EXPECT_FALSE(flight.steady(2.5));
  EXPECT_TRUE(flight.tracker.hasLast());
}

TEST(PlaneTracker, KeepsThePlaneForAFewPairsWithoutOne) {
  Flight flight;
  flight.see(1, 2);
  for (int i = 1; i <= 4; ++i) {
    flight.miss(1 + 0.1 * i);
    EXPECT_TRUE(flight.tracker.hasLast()) << i;
  }
  flight.miss(1.5);
  EXPECT_FALSE(flight.tracker.hasLast());
}

TEST(PlaneTracker, ForgetsAllWhenTheClockIsSetBack) {
  Flight flight;
  for (const double t : {1.0, 1.1}) flight.see(t, 2);
  EXPECT_FALSE(flight.steady(1.05));
  EXPECT_FALSE(flight.tracker.hasLast());
}

TEST(PlaneTracker, IsNotSteadyAfterAGapThatIsLongForPairs) {
  Flight flight;
  for (const double t : {1.0, 1.1}) flight.see(t, 2);
  for (const double t : {1.2, 1.3, 1.4}) flight.miss(t);
  flight.see(1.5, 2);
  flight.see(1.6, 2);
  ASSERT_TRUE(flight.steady(1.7));
  flight.miss(1.8);
  flight.miss(1.9);
  flight.see(2.0, 2);
  EXPECT_FALSE(flight.steady(2.3)) << "pairs come each tenth of a second, planes did not";
}

TEST(PlaneTracker, IsNotSteadyOnAPlaneThatSomethingSpeaksAgainst) {
  Flight flight;
  for (const double t : {1.0, 1.1, 1.2}) flight.see(t, 2);
  ASSERT_TRUE(flight.steady(1.3));
  flight.tracker.remember(flight.result(2), false);
  EXPECT_FALSE(flight.steady(1.4));
  flight.see(1.5, 2);
  EXPECT_TRUE(flight.steady(1.6));
}

TEST(PlaneTracker, IsBorneOutByCornersThatAgreeAndAPlaneThatIsNear) {
  Flight flight;
  for (const double t : {1.0, 1.1}) flight.see(t, 2, 80);
  ASSERT_TRUE(flight.steady(1.2));
  EXPECT_TRUE(flight.tracker.bearsOut(flight.result(2, 80)));
  EXPECT_TRUE(flight.tracker.bearsOut(flight.result(2, 73)));
  EXPECT_FALSE(flight.tracker.bearsOut(flight.result(2, 70)));
  double near = 2, far = 2;
  while (flight.disparity(near) < flight.disparity(2) + 1.4) near -= 1e-3;
  while (flight.disparity(far) < flight.disparity(2) + 1.6) far -= 1e-3;
  EXPECT_TRUE(flight.tracker.bearsOut(flight.result(near, 80)));
  EXPECT_FALSE(flight.tracker.bearsOut(flight.result(far, 80)));
}

}  // namespace
}  // namespace uav_landing
