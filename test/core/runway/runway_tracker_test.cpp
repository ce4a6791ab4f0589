#include "runway/position/runway_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/ground_line.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Movement;
using test::Pose;

/// Two painted lines at y = +-1.1 m, seen from left of their middle on a path that goes down and to the
/// right.
struct Approach {
  StereoRig rig = test::makeRig(480, 360, 0.65);
  RigModel model = test::makeModel(rig);
  GroundRenderer ground{61};
  ApproachAngleParameters parameters;
  RunwayTracker tracker;
  int frame = 0;
  bool third_line = false;       ///< the other edge line of a runway whose left half the two lines are
  double time = 0, climbed = 0;  // s, m
  double other_runway = 0;       // probability
  std::optional<Pose> last;

  /// known_width: m, or 0.
  explicit Approach(double known_width = 0) : tracker(model, parameters, {known_width}) {
    ground.contrast = 2;
    ground.line_offset = 1.1;
    ground.line_width = 0.12;
  }
  Pose pose() const {
    Pose now;
    now.position = {0.1 * frame, 0.4 - 0.01 * frame, 1.7 - 0.01 * frame + climbed};
    now.pitch = -6 * kDegree;
    now.roll = (3 - 0.5 * frame) * kDegree;
    now.yaw = (-4 + 0.3 * frame) * kDegree;
    return now;
  }
  /// One pair. y_shift: by which the world was moved to the left without the motion knowing.
  ApproachAngleResult::Runway next(double y_shift = 0, bool blank = false) {
    const Pose now = pose();
    Pose drawn = now;
    drawn.position.y() -= y_shift;
    cv::Mat left = ground.left(rig, drawn), right = ground.right(rig, drawn);
    if (blank) {
      left.setTo(100);
      right.setTo(100);
    }
    Timings timings;
    RunwayDirectionMemory memory;
    const Eigen::Vector3d n = now.down();
    const SeenGround ground_seen{{n / now.height(), Eigen::Matrix3d::Identity() * 1e-8}, {}};
    RunwayDirection direction = findRunwayDirection({rig, {left, model.left_mask}, {right, model.right_mask}},
                                                    &ground_seen, parameters, memory, timings);
    if (third_line) addThirdLine(now, direction);
    ApproachAngleResult approach;
    approach.stamp = time += 0.05;
    approach.other_runway_probability = other_runway;
    approach.left = direction.left;
    approach.right = direction.right;
    approach.n = n;
    approach.n_covariance = Eigen::Matrix3d::Identity() * std::pow(0.02 * kDegree, 2);
    approach.step.failure = {Reason::kNotYet, ""};
    if (last) {
      approach.step.failure = {};
      approach.step.translation_over_height = Movement(*last, now).t / now.height();
      approach.step.covariance = Matrix6d::Identity() * 1e-6;
    }
    last = now;
    ++frame;
    return tracker.process({left, model.left_mask}, approach, direction, now.height());
  }
  /// One view alone sees it.
  void addThirdLine(const Pose& now, RunwayDirection& direction) const {
    const double from = now.position.x() + 4, to = from + 20;
    for (const int side : {-1, 1})
      direction.left_lines.push_back(test::groundLine(rig, now, -3.3 + 0.06 * side, from, to, 0, side < 0));
  }
  /// A pair that shows nothing, after which the motion begins.
  void skip() {
    last = pose();
    ++frame;
    tracker.skip(time += 0.05);
  }
};

TEST(RunwayTracker, TellsThePositionAfterThreePairsThatAgree) {
  Approach approach;
  EXPECT_EQ(approach.next().failure.reason, Reason::kNotYet);
  EXPECT_EQ(approach.next().failure.reason, Reason::kNotYet);
  for (int i = 0; i < 4; ++i) {
    const Pose pose = approach.pose();
    const auto runway = approach.next();
    ASSERT_FALSE(runway.failure) << runway.failure.message();
    const double error = runway.y * pose.height() - pose.position.y();
    EXPECT_LT(std::abs(error), 0.02);
    EXPECT_LT(std::abs(error), 3 * std::sqrt(runway.y_variance) * pose.height());
    EXPECT_NEAR(runway.width * pose.height(), 2 * 1.1 + 0.12, 0.05);
    EXPECT_TRUE(runway.threshold_failure) << "there is none";
    const auto& [without, variance] = runway.y_without[CentreSource::kDirection];
    EXPECT_LT(std::abs(without - runway.y), 3 * std::sqrt(variance)) << "two lines show their direction";
    EXPECT_TRUE(std::isnan(runway.y_without[CentreSource::kLeftEdge].value)) << "and nothing checks them";
  }
}

TEST(RunwayTracker, EdgesOfWhatMayBeNoRunwayTellNoPlace) {
  Approach approach;
  for (int i = 0; i < 5; ++i) approach.next();
  approach.other_runway = 0.02;
  const auto doubted = approach.next();
  EXPECT_EQ(doubted.failure.reason, Reason::kNoRunway);
  EXPECT_NE(doubted.failure.detail.find("probability of 0.02, at most 0.01"), std::string::npos)
      << doubted.failure.detail;
  EXPECT_TRUE(doubted.threshold_failure);
  EXPECT_TRUE(std::isnan(doubted.y) && std::isnan(doubted.x) && std::isnan(doubted.width));
  approach.other_runway = 0.005;
  EXPECT_FALSE(approach.next().failure) << "it was followed all the same";
}

TEST(RunwayTracker, EdgesOfAnotherWidthThanTheKnownOneAreTakenAsIfNoneWereKnown) {
  // Stripes inside the chart's width, for instance.
  Approach known(2 * 1.1 + 0.12), other(1.3 * (2 * 1.1 + 0.12)), unknown;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(bool(known.next().failure), i < 2) << i;
    const auto seen = other.next(), without = unknown.next();
    EXPECT_EQ(bool(seen.failure), bool(without.failure)) << i;
    if (!seen.failure) EXPECT_EQ(seen.y, without.y);
  }
}

TEST(RunwayTracker, DoesNotBelieveARunwayThatJumps) {
  Approach approach;
  for (int i = 0; i < 4; ++i) approach.next();
  const auto jumped = approach.next(0.5);
  EXPECT_TRUE(jumped.failure);
  EXPECT_TRUE(std::isnan(jumped.y));
  EXPECT_FALSE(approach.next().failure) << "back at its place";
}

TEST(RunwayTracker, TakesARunwayThatStaysElsewhereAfterASecond) {
  Approach approach;
  for (int i = 0; i < 4; ++i) approach.next();
  int unknown = 0;
  while (unknown < 40 && approach.next(0.5).failure) ++unknown;
  EXPECT_GE(unknown, 20) << "1 s of pairs every 50 ms";
  EXPECT_LT(unknown, 30);
}

TEST(RunwayTracker, FindsItAgainAtOnceAfterAPairWithoutEdges) {
  Approach approach;
  for (int i = 0; i < 4; ++i) approach.next();
  EXPECT_TRUE(approach.next(0, true).failure);
  EXPECT_FALSE(approach.next().failure);
}

TEST(RunwayTracker, DoesNotKnowHowTheCameraMovedOverPairsThatAreSkipped) {
  Approach approach;
  for (int i = 0; i < 4; ++i) approach.next();
  approach.skip();
  EXPECT_FALSE(approach.next(0.5).failure) << "as far to the side as nobody would believe otherwise";
}

TEST(RunwayTracker, ForgetsTheWidthWithTheRunway) {
  Approach approach;
  for (int i = 0; i < 6; ++i) approach.next();
  for (int i = 0; i < 22; ++i) approach.next(0, true);
  approach.climbed = 1;  // from where it is narrower, in heights
  for (int i = 0; i < 2; ++i) approach.next();
  const auto runway = approach.next();
  EXPECT_FALSE(runway.failure) << runway.failure.message();
  EXPECT_NEAR(runway.width * (approach.last->height()), 2 * 1.1 + 0.12, 0.05);
}

TEST(RunwayTracker, OnePairIsNotEnoughForAWidth) {
  Approach approach;
  for (int i = 0; i < 2; ++i) approach.next();
  approach.ground.line_offset = 1.5;
  EXPECT_FALSE(approach.next().failure) << "the middle is where it was";
  approach.ground.line_offset = 1.1;
  approach.next();
  const auto runway = approach.next();
  EXPECT_NEAR(runway.width * (approach.last->height()), 2 * 1.1 + 0.12, 0.05);
}

TEST(RunwayTracker, IsSettledWhileThePairsShowTheSameRunway) {
  Approach approach;
  const auto settled = [&] { return approach.tracker.isSettled(approach.time + 0.05); };
  const auto settle = [&] {
    for (int i = 0; i < 3; ++i) {
      EXPECT_FALSE(settled()) << i;
      approach.next();
    }
    EXPECT_TRUE(settled());
  };
  settle();
  approach.next(0, true);
  EXPECT_FALSE(settled()) << "not seen";
  approach.next();
  EXPECT_TRUE(settled());
  approach.next(0.5);
  EXPECT_FALSE(settled()) << "seen elsewhere";
  approach.next();
  EXPECT_TRUE(settled());
  approach.skip();
  EXPECT_FALSE(settled()) << "skipped";
  approach.next();
  EXPECT_TRUE(settled());
  EXPECT_FALSE(approach.tracker.isSettled(approach.time)) << "the stamp stands";
  EXPECT_FALSE(approach.tracker.isSettled(approach.time - 1)) << "the stamp went back";
  EXPECT_FALSE(approach.tracker.isSettled(approach.time + 1.1)) << "long ago";
  approach.time -= 5;
  settle();
}

TEST(RunwayTracker, RemembersThatTwoLinesAreHalfOfAWiderRunway) {
  const auto pairsUntilBelieved = [](int halves) {
    Approach approach;
    approach.third_line = true;
    for (int i = 0; i < halves; ++i)
      EXPECT_EQ(approach.next().failure.detail, "the runway reaches as far again beyond its seeming edges");
    approach.third_line = false;
    int pairs = 1;
    while (approach.next().failure && pairs < 200) {
      approach.frame = 0;  // it hovers
      approach.last = approach.pose();
      ++pairs;
    }
    return pairs;
  };
  EXPECT_EQ(pairsUntilBelieved(0), 3);
  EXPECT_EQ(pairsUntilBelieved(2), 3) << "two pairs may be wrong";
  const int known = pairsUntilBelieved(3);
  EXPECT_GT(known, 60) << "3 s";
  EXPECT_LT(known, 70);
}

TEST(RunwayTracker, ForgetsOnReset) {
  Approach approach;
  for (int i = 0; i < 4; ++i) approach.next();
  approach.tracker.reset();
  EXPECT_EQ(approach.next().failure.reason, Reason::kNotYet);
}

TEST(RunwayTracker, SinglePairsWithoutEdgesDoNotAddUp) {
  Approach approach;
  for (int i = 0; i < 4; ++i) approach.next();
  for (int i = 0; i < 5; ++i) {
    approach.time += 0.4;  // five such pairs last longer than the edges may be out of sight at once
    EXPECT_TRUE(approach.next(0, true).failure) << i;
    EXPECT_FALSE(approach.next().failure) << i;
  }
}

/// The lines are seen elsewhere from now on, m from their middle. Returns whether this pair has a width.
bool seesWidth(Approach& approach, double line_offset) {
  approach.ground.line_offset = line_offset;
  return std::isfinite(approach.next().width);
}

TEST(RunwayTracker, TakesAWiderWidthThatThreePairsSawWhicheverOfItsLinesTheySaw) {
  Approach approach;
  for (int i = 0; i < 6; ++i) approach.next();
  for (const double offset : {1.5, 1.58, 1.5}) EXPECT_FALSE(seesWidth(approach, offset)) << offset;
  EXPECT_TRUE(seesWidth(approach, 1.5));
}

TEST(RunwayTracker, AWiderWidthIsTheSameInHeightsAsFarAsTheMovementIsNotKnown) {
  Approach approach;
  for (int i = 0; i < 6; ++i) approach.next();
  EXPECT_FALSE(seesWidth(approach, 1.5));
  approach.climbed = 0.22;  // a ninth less of it in heights, and no motion says so
  approach.skip();
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(seesWidth(approach, 1.5)) << i;
  EXPECT_TRUE(seesWidth(approach, 1.5));
}

}  // namespace
}  // namespace uav_landing
