#include <gtest/gtest.h>

#include "support/stereo_stage_scene.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {
namespace {

using test::expectPose;
using test::makePose;
using test::Pose;
using Scene = test::StereoStageScene;
using Pair = test::StereoStageScene::Pair;

/// The stage searches as in flight, over several pairs.
Scene searching(unsigned seed) {
  Scene scene(seed);
  scene.parameters.search_at_once = false;
  return scene;
}

// In half a second while it sinks, of pairs at this rate.
StereoDepthResult searchOverPairs(const Scene& scene, StereoDepthStage& stage, double rate, Pose& pose) {
  StereoDepthResult result;
  for (int i = 0; i <= 0.5 * rate; ++i) {
    pose = makePose(2 - 0.4 * i / rate, -8 + 2 * i / rate, 0);
    const Pair pair = scene.render(pose);
    result = stage.process(1 + i / rate, pair.left, pair.right);
    if (!result.failure) break;
    EXPECT_EQ(result.failure.reason, Reason::kNotYet) << result.failure.message();
  }
  return result;
}

TEST(StereoDepthSearch, SearchesOverSomePairsAndFindsThePlaneOfTheLast) {
  for (const double rate : {10, 20, 50}) {
    Scene scene = searching(14);
    StereoDepthStage stage(scene.model, scene.parameters);
    Pose pose;
    const StereoDepthResult result = searchOverPairs(scene, stage, rate, pose);
    expectPose(result, pose, "searched");
    EXPECT_TRUE(result.from_search);
    EXPECT_LT(pose.height(), 2) << "not with the first pair";
  }
}

TEST(StereoDepthSearch, SearchesWithinOnePairWherePairsAreRare) {
  Scene scene = searching(14);
  StereoDepthStage stage(scene.model, scene.parameters);
  const Pose pose = makePose(2, -8, 0);
  const Pair pair = scene.render(pose), other = scene.render(makePose(3, -8, 0));
  EXPECT_EQ(stage.process(1, other.left, other.right).failure.reason, Reason::kNotYet);
  expectPose(stage.process(1.5, pair.left, pair.right), pose, "half a second later");
}

// A pair that comes late does not make the next ones come late, too.
TEST(StereoDepthSearch, GoesOnWithTheSearchOverPairsAfterOneGap) {
  Scene scene = searching(14);
  StereoDepthStage stage(scene.model, scene.parameters);
  const Pair pair = scene.render(makePose(2, -8, 0)), elsewhere = scene.render(makePose(0.7, -8, 0));
  for (int i = 0; i < 6; ++i) stage.process(1 + 0.05 * i, pair.left, pair.right);
  EXPECT_EQ(stage.process(1.6, elsewhere.left, elsewhere.right).failure.reason, Reason::kNotYet);
}

TEST(StereoDepthSearch, ForgetsWhatASearchHasSaidWhenStampsJumpBack) {
  Scene scene = searching(10);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  StereoDepthStage stage(scene.model, scene.parameters);
  for (int i = 0; i < 12; ++i) stage.process(5 + 0.05 * i, pair.right, pair.left);
  EXPECT_EQ(stage.process(1, pair.left, pair.right).failure.reason, Reason::kNotYet);
}

TEST(StereoDepthSearch, ForgetsThePairThatItSearchesWhenStampsJumpBackOrAfterAReset) {
  Scene scene = searching(14);
  const Pair high = scene.render(makePose(6, -8, 0));
  for (const bool reset : {false, true}) {
    StereoDepthStage stage(scene.model, scene.parameters);
    EXPECT_TRUE(stage.process(9, high.left, high.right).failure);
    if (reset) stage.reset();
    Pose pose;
    expectPose(searchOverPairs(scene, stage, 20, pose), pose, "after another pair");
  }
}

TEST(StereoDepthSearch, SaysOverSomePairsThatTheImagesAreSwapped) {
  Scene scene = searching(10);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  StereoDepthStage stage(scene.model, scene.parameters);
  Reason reason = Reason::kNone;
  for (int i = 0; i < 20; ++i) {
    const Reason now = stage.process(1 + 0.05 * i, pair.right, pair.left).failure.reason;
    const bool was_told = reason == Reason::kNegativeDisparity;
    reason = now;
    if (i >= 10 || was_told) {
      EXPECT_EQ(reason, Reason::kNegativeDisparity) << i;
    }
  }
}

}  // namespace
}  // namespace uav_landing
