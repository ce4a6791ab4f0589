#include "stereo/plane/plane_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "image/windows/match_image.h"
#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::makePose;
using test::Pose;
using State = PlaneSearch::State;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// A rig over textured ground, with the level that a search looks at.
struct Ground {
  StereoRig rig = test::makeRig(640, 480, 1.0);
  RigModel model = test::makeModel(rig);
  GroundRenderer renderer{17};
  StereoDepthParameters parameters;
  PlaneLimits limits{30 * kDegree, 30 * kDegree, 20, 0.6};
  int factor = coarseFactor(rig.size);

  Ground() { renderer.grain = 0.05; }

  PlaneSearch search() const { return PlaneSearch(model, factor, parameters, limits); }
  StereoLevel at(const Pose& pose) const {
    return levelOf(renderer.left(rig, pose), renderer.right(rig, pose));
  }
  StereoLevel swappedAt(const Pose& pose) const {
    return levelOf(renderer.right(rig, pose), renderer.left(rig, pose));
  }
  StereoLevel levelOf(const cv::Mat& left, const cv::Mat& right) const {
    MatchImage left_image, right_image;
    left_image.assign(left);
    right_image.assign(right);
    StereoLevel level = reduceLevel(model, factor, parameters.window_radius + 2);
    level.left = left_image.coarse;
    level.right = right_image.coarse;
    return level;
  }
  /// Largest error of the disparity over the lowest row, pixels at full size.
  double error(const Eigen::Vector3d& g, const Pose& pose) const {
    const Eigen::Vector3d off = g - pose.down() / pose.height();
    const double bottom = rig.size.height - 1, right = rig.size.width - 1;
    return rig.fb() *
           std::max(std::abs(off.dot(rig.ray(0, bottom))), std::abs(off.dot(rig.ray(right, bottom))));
  }
};

// The next step looks within six pixels of the coarse level.
constexpr double kUseful = 3;

TEST(PlaneSearch, FindsThePlaneFromFarToNear) {
  const Ground ground;
  for (const double height : {1.0, 2.0, 5.0, 12.0, 30.0})
    for (const double pitch : {-15.0, -4.0})
      for (const double roll : {0.0, 12.0}) {
        const Pose pose = makePose(height, pitch, roll);
        PlaneSearch search = ground.search();
        ASSERT_EQ(search.advance(ground.at(pose), kNoLimit), State::kFound)
            << height << " m, " << pitch << ", " << roll;
        EXPECT_LT(ground.error(search.plane(), pose), kUseful) << height << " m, " << pitch << ", " << roll;
        EXPECT_TRUE(search.beganHere());
      }
}

TEST(PlaneSearch, FindsInStepsWhatItFindsAtOnceInThePairThatItBeganWith) {
  const Ground ground;
  const Pose pose = makePose(8, -5, 3), other = makePose(20, -12, -6);
  PlaneSearch at_once = ground.search(), in_steps = ground.search();
  ASSERT_EQ(at_once.advance(ground.at(pose), kNoLimit), State::kFound);
  State state = in_steps.advance(ground.at(pose), 1);
  EXPECT_TRUE(in_steps.beganHere());
  int steps = 1;
  for (; state == State::kGoesOn; ++steps) {
    ASSERT_LT(steps, 100);
    state = in_steps.advance(ground.at(other), 1);
    EXPECT_FALSE(in_steps.beganHere());
  }
  ASSERT_EQ(state, State::kFound);
  EXPECT_EQ(in_steps.plane().vector(), at_once.plane().vector());
  EXPECT_GT(steps, 10);
}

TEST(PlaneSearch, BeginsAnewAfterItWasStopped) {
  const Ground ground;
  const Pose pose = makePose(8, -5, 3);
  PlaneSearch search = ground.search();
  ASSERT_EQ(search.advance(ground.at(makePose(20, -12, -6)), 1), State::kGoesOn);
  search.stop();
  ASSERT_EQ(search.advance(ground.at(pose), kNoLimit), State::kFound);
  EXPECT_LT(ground.error(search.plane(), pose), kUseful);
}

// At 20 Hz; the pair that confirms it comes after that.
TEST(PlaneSearch, IsDoneInLessThanHalfASecondOfPairs) {
  for (const cv::Size& size : {cv::Size(320, 240), cv::Size(640, 480), cv::Size(1280, 960)}) {
    Ground ground;
    ground.rig = test::makeRig(size.width, size.height, 1.0);
    ground.model = test::makeModel(ground.rig);
    ground.factor = coarseFactor(size);
    PlaneSearch search = ground.search();
    const StereoLevel level = ground.at(makePose(8, -5, 0));
    State state = State::kGoesOn;
    int pairs = 0;
    for (; state == State::kGoesOn && pairs < 10; ++pairs)
      state = search.advance(level, PlaneSearch::budgetOf(size));
    EXPECT_EQ(state, State::kFound) << size;
    EXPECT_LE(pairs, 6) << size;
  }
}

TEST(PlaneSearch, TellsThatLeftAndRightAreExchanged) {
  const Ground ground;
  PlaneSearch search = ground.search();
  EXPECT_EQ(search.advance(ground.swappedAt(makePose(8, -5, 0)), kNoLimit), State::kSwapped);
  // As long as nothing else is known, without looking again.
  const cv::Mat black(ground.rig.size, CV_8UC1, cv::Scalar(0));
  EXPECT_EQ(search.advance(ground.levelOf(black, black), kNoLimit), State::kSwapped);
  search.reset();
  EXPECT_EQ(search.advance(ground.levelOf(black, black), kNoLimit), State::kNotFound);
}

}  // namespace
}  // namespace uav_landing
