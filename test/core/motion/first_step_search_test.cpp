#include "motion/step/first_step_search.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "image/windows/corners.h"
#include "motion/step/step_search.h"
#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Movement;
using test::Pose;

constexpr double kPeriod = 0.05;  // s

/// A level flight over rendered ground, and the search for its motion pair by pair.
struct Flight {
  StereoRig rig = test::makeRig(320, 240, 0.65);
  GroundRenderer ground{51};
  double speed = 4;     // m/s
  double height = 1.7;  // m
  SearchTime time = SearchTime::kShort;
  ApproachAngleParameters parameters;
  StepMatching matching{rig, cv::Mat(rig.size, CV_8UC1, cv::Scalar(255)), parameters};
  FirstStepSearch search{false};
  MotionSearchMemory memory;
  RowRates rates{1e-3};

  Pose at(double t) const {
    Pose pose;
    pose.position = {speed * t, 0, height};
    pose.pitch = -8 * kDegree;
    return pose;
  }
  MatchImage image(double t) const {
    MatchImage image;
    image.assign(ground.left(rig, at(t)));
    return image;
  }
  /// Of the step that ends with this pair.
  std::optional<CameraMotion> pair(int i, const RotationPrior* rotation = nullptr, double period = kPeriod) {
    const MatchImage now = image(i * period), then = image((i - 1) * period);
    cv::Mat below = cv::Mat::zeros(rig.size, CV_8UC1);
    below.rowRange(110, 230) = 255;
    std::vector<TrackedCorner> corners;
    for (const cv::Point& p : findCorners(ground.left(rig, at(i * period)), below, {250, 1e-7, 4, 0.04}))
      corners.push_back({p.x, p.y, true, 0, 0});
    memory.matching.textures.clear();
    const Eigen::Vector3d n = at(0).down();
    return search.advance(matching, {now,
                                     then,
                                     period,
                                     corners,
                                     memory,
                                     rates,
                                     {n, 1e-7 * (Eigen::Matrix3d::Identity() - n * n.transpose())},
                                     rotation,
                                     false,
                                     time});
  }
  /// Pairs until the motion is known; 0: not within twenty.
  int pairsUntilKnown(std::optional<CameraMotion>& found) {
    for (int i = 1; i <= 20; ++i)
      if ((found = pair(i))) return i;
    return 0;
  }
  void expectRight(const CameraMotion& found, double period = kPeriod) const {
    const Eigen::Vector3d t = Movement(at(0), at(period)).t / height;
    EXPECT_LT((found.t - t).norm(), 0.05 * t.norm()) << found.t.transpose() << "; right: " << t.transpose();
  }
};

TEST(FirstStepSearch, TriesThreeSpeedsAPairWhileTheRunwayIsLookedForToo) {
  for (const double speed : {1.0, 4.0, 12.0}) {
    Flight flight;
    flight.speed = speed;
    std::optional<CameraMotion> found;
    EXPECT_EQ(flight.pairsUntilKnown(found), 3);
    ASSERT_TRUE(found);
    flight.expectRight(*found);
  }
}

TEST(FirstStepSearch, TriesOneSpeedAPairWhileTheGroundIsLookedForToo) {
  Flight flight;
  flight.time = SearchTime::kLeast;
  std::optional<CameraMotion> found;
  EXPECT_EQ(flight.pairsUntilKnown(found), 9);
  ASSERT_TRUE(found);
  flight.expectRight(*found);
}

TEST(FirstStepSearch, TriesAllInAPairWithNothingElseToDoOrAsPeopleWant) {
  Flight idle, wanted;
  idle.time = SearchTime::kAmple;
  wanted.search = FirstStepSearch(true);
  for (Flight* flight : {&idle, &wanted}) {
    const std::optional<CameraMotion> found = flight->pair(1);
    ASSERT_TRUE(found);
    flight->expectRight(*found);
  }
}

TEST(FirstStepSearch, TriesAllInAStepThatTakesLong) {
  Flight flight;
  flight.speed = 0.8;
  const std::optional<CameraMotion> found = flight.pair(1, nullptr, 0.4);
  ASSERT_TRUE(found);
  flight.expectRight(*found, 0.4);
}

/// Along the path, over hardly any texture: few corners agree with any speed, and many with a wrong one.
void paintLines(GroundRenderer& ground, double contrast) {
  ground.contrast = contrast;
  ground.line_offset = 0.5;
  ground.bar_period = 0.6;
  ground.bar_from = -10;
  ground.bar_to = 60;
  ground.bar_reach = 2.5;
}

TEST(FirstStepSearch, OverLinesComparesWhatAllCornersLookLikeOverSeveralPairs) {
  for (const double speed : {2.0, 6.0, 10.0, 20.0}) {
    SCOPED_TRACE(speed);
    Flight flight;
    flight.speed = speed;
    paintLines(flight.ground, 4);
    std::optional<CameraMotion> found;
    const int pairs = flight.pairsUntilKnown(found);
    ASSERT_TRUE(found);
    EXPECT_LE(pairs, 8);
    flight.expectRight(*found);
  }
}

TEST(FirstStepSearch, BeginsAnewAfterARestart) {
  Flight flight;
  EXPECT_FALSE(flight.pair(1));
  EXPECT_FALSE(flight.pair(2));
  flight.search.restart();
  EXPECT_FALSE(flight.pair(3));
  EXPECT_FALSE(flight.pair(4));
  EXPECT_TRUE(flight.pair(5));
}

TEST(FirstStepSearch, ForgetsWhatItFoundBeforeAGap) {
  Flight flight;
  flight.speed = 0.8;
  flight.pair(1);
  flight.pair(2);
  const std::optional<CameraMotion> found = flight.pair(3, nullptr, 0.4);
  ASSERT_TRUE(found);
  flight.expectRight(*found, 0.4);
}

TEST(FirstStepSearch, AfterAKnownRotationFailedItDoesWithoutIt) {
  Flight flight;
  const RotationPrior wrong{Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                            1e-8 * Eigen::Matrix3d::Identity()};
  std::optional<CameraMotion> found;
  for (int i = 1; i <= 30 && !found; ++i) found = flight.pair(i, &wrong);
  ASSERT_TRUE(found);
  EXPECT_GT(Eigen::AngleAxisd(found->R).angle(), 0.1) << "the wrong rotation was not tried";
  flight.search.fail();
  found.reset();
  for (int i = 31; i <= 60 && !found; ++i) found = flight.pair(i, &wrong);
  ASSERT_TRUE(found);
  flight.expectRight(*found);
}

}  // namespace
}  // namespace uav_landing
