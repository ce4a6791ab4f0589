#include "uav_landing/stages/stereo_depth_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "image/input/image_check.h"
#include "support/stereo_stage_scene.h"

namespace uav_landing {
namespace {

using test::expectPose;
using test::Exposure;
using test::GroundRenderer;
using test::kDegree;
using test::makePose;
using test::Pose;
using Scene = test::StereoStageScene;
using Pair = test::StereoStageScene::Pair;

TEST(StereoDepthStage, FindsThePlaneFromFarToVeryLow) {
  // At 0.48 m the nearest ground has a disparity of two thirds of the width.
  for (const double height : {8.0, 4.0, 2.0, 1.0, 0.48}) {
    const Scene scene(1, 0.005 * height);
    const Pose pose = makePose(height, -8, 0);
    const StereoDepthResult result = scene.first(scene.render(pose));
    expectPose(result, pose, std::to_string(height));
    EXPECT_TRUE(result.from_search);
  }
  const Scene scene(1);
  const GroundPlane low = test::exactPlane(makePose(0.48, -8, 0), 0, 0);
  EXPECT_GT(low.disparity(scene.rig, 160, 239), 320 * 2 / 3.0);
}

TEST(StereoDepthStage, FindsThePlaneWhateverPitchAndRoll) {
  for (const double pitch : {-15.0, -6.0, 3.0})
    for (const double roll : {-10.0, 0.0, 10.0}) {
      const Scene scene(2);
      const Pose pose = makePose(1.6, pitch, roll);
      expectPose(scene.first(scene.render(pose)), pose, std::to_string(pitch) + " " + std::to_string(roll));
    }
}

TEST(StereoDepthStage, GivesTheSamePlaneTrackingAsSearching) {
  const Scene scene(3);
  StereoDepthStage tracking(scene.model, scene.parameters);
  for (int i = 0; i < 4; ++i) {
    const Pose pose = makePose(1.5 - 0.08 * i, -8 + 0.6 * i, -3 + 1.5 * i);
    const Pair pair = scene.render(pose);
    const StereoDepthResult tracked = tracking.process(i * 0.1, pair.left, pair.right);
    const StereoDepthResult searched = scene.first(pair);
    expectPose(tracked, pose, "tracked");
    ASSERT_FALSE(searched.failure);
    EXPECT_EQ(tracked.from_search, i == 0);
    EXPECT_TRUE(searched.from_search);
    EXPECT_NEAR(tracked.plane.height(), searched.plane.height(),
                0.5 * std::sqrt(searched.plane.heightVariance()));
  }
}

TEST(StereoDepthStage, IsBlindToGainAndOffsetBetweenTheCameras) {
  const Scene scene(4);
  const Pose pose = makePose(1.6, -8, 4);
  expectPose(scene.first(scene.render(pose, {1, 0, 1}, {0.8, 45, 1})), pose, "flatter");
  expectPose(scene.first(scene.render(pose, {1, 0, 1}, {1.15, -10, 1})), pose, "brighter");
}

TEST(StereoDepthStage, IsNotBlindToThemBySsd) {
  // The paper's choice works with equal cameras only.
  Scene scene(4);
  scene.parameters.matching_cost = MatchingCost::kSsd;
  scene.parameters.warp_window = false;
  const Pose pose = makePose(3, -8, 0);
  const StereoDepthResult same = scene.first(scene.render(pose));
  ASSERT_FALSE(same.failure) << same.failure.message();
  EXPECT_NEAR(same.plane.height(), 3, 0.15);
  const StereoDepthResult different = scene.first(scene.render(pose, {1, 0, 1}, {0.8, 45, 1}));
  EXPECT_TRUE(different.failure || different.points.size() < 0.8 * same.points.size());
}

TEST(StereoDepthStage, SurvivesNoise) {
  const Scene scene(5);
  const Pose pose = makePose(1.6, -8, 2);
  expectPose(scene.first(scene.render(pose, {1, 0, 5}, {0.95, 3, 5})), pose, "noise");
}

TEST(StereoDepthStage, IsNotPulledByBoxesOnTheGround) {
  Scene scene(6);
  scene.ground.boxes = {
      {{3, -2.5, 0}, {5, -0.8, 1.0}}, {{4, 0.7, 0}, {6, 2.5, 1.2}}, {{9, -4, 0}, {12, 0, 2}}};
  const Pose pose = makePose(1.6, -6, -2);
  // Most blocks stand on the ground, so that the plane of the first pair waits for the second.
  StereoDepthStage stage(scene.model, scene.parameters);
  const Pair pair = scene.render(pose);
  stage.process(1, pair.left, pair.right);
  const StereoDepthResult result = stage.process(1.1, pair.left, pair.right);
  expectPose(result, pose, "boxes");
  // Where the picture is another without the boxes, for the width of a window: no ground is to be seen.
  GroundRenderer bare = scene.ground;
  bare.boxes.clear();
  cv::Mat box;
  cv::absdiff(scene.ground.left(scene.rig, pose, {1, 0, 0}), bare.left(scene.rig, pose, {1, 0, 0}), box);
  cv::morphologyEx(box > 0, box, cv::MORPH_CLOSE, cv::Mat(), {-1, -1}, 3);
  box = erodeMask(box, scene.parameters.window_radius);
  ASSERT_GT(cv::countNonZero(box), 5000);
  int on_box = 0;
  for (const StereoDepthResult::Point& point : result.points)
    on_box += point.on_plane && box.at<uchar>(cvRound(point.v), cvRound(point.u)) != 0;
  EXPECT_LT(on_box, 0.03 * static_cast<double>(result.points.size()));
}

TEST(StereoDepthStage, DoesNotLockOnePeriodOffOnZebraBars) {
  Scene scene(7);
  // Bars all over the near ground, which fit on each other at every period, and texture between them. At 0.7
  // m half of what the left camera sees of them is outside the right view, and its places one bar off are
  // not. The other heights are such that ranges of slopes that the search goes through hold the planes one
  // bar off besides the right one, or each alone.
  scene.ground.contrast = 5;
  scene.ground.bar_from = 1;
  scene.ground.bar_to = 9;
  scene.ground.bar_reach = 3;
  for (const double period : {0.24, 0.4})
    for (const double height : {2.5, 1.7, 1.6, 1.2, 0.9, 0.88, 0.7}) {
      scene.ground.bar_period = period;
      const Pose pose = makePose(height, -9, 0);
      expectPose(scene.first(scene.render(pose)), pose,
                 std::to_string(period) + " " + std::to_string(height));
    }
}

TEST(StereoDepthStage, FollowsAnApproachAndRollAtFullSize) {
  Scene scene(8);
  scene.rig = test::makeRig(640, 480, 1.0);
  scene.model = test::makeModel(scene.rig);
  scene.ground.grain = 0.05;
  StereoDepthStage stage(scene.model, scene.parameters);
  for (int i = 0; i < 3; ++i) {
    const Pose pose = makePose(12 - 0.5 * i, -4 + i, 3.0 * i - 4);
    const Pair pair = scene.render(pose);
    expectPose(stage.process(i * 0.1, pair.left, pair.right), pose, "full size");
  }
}

TEST(StereoDepthStage, FollowsThePlaneWhereMostOfThePictureIsSomethingElse) {
  const Scene scene(18);
  StereoDepthStage stage(scene.model, scene.parameters);
  const Pair first = scene.render(makePose(1.6, -8, 0));
  stage.process(1, first.left, first.right);
  const Pose pose = makePose(1.55, -8, 0);
  const Pair pair = scene.render(pose);
  cv::Mat part = pair.right.colRange(0, 190);
  cv::randu(part, 0, 255);
  const StereoDepthResult result = stage.process(1.1, pair.left, pair.right);
  EXPECT_FALSE(result.from_search);
  expectPose(result, pose, "with noise");
}

/// Most of the right picture is noise: corners find the plane, but most blocks are not on it.
Pair mostlyNoise(const Scene& scene, double height) {
  const Pair pair = scene.render(makePose(height, -8, 0));
  cv::Mat part = pair.right.colRange(0, 190);
  cv::randu(part, 0, 255);
  return pair;
}

TEST(StereoDepthStage, LooksForNoMoreCornersThanTheImageHasRoomFor) {
  Scene scene(12);
  const Pair pair = scene.render(makePose(1.5, -10, 0));
  const auto corners = [&](int pixels_per_corner) {
    scene.parameters.pixels_per_corner = pixels_per_corner;
    const StereoDepthResult result = scene.first(pair);
    EXPECT_FALSE(result.failure) << pixels_per_corner << ": " << result.failure.message();
    return result.corners;
  };
  EXPECT_EQ(corners(1), StereoDepthParameters().corner_count);
  EXPECT_EQ(corners(300), 320 * 240 / 300);
  EXPECT_EQ(corners(600), 320 * 240 / 600);
}

TEST(StereoDepthStage, BelievesAPlaneThatOnlyCornersFoundWhenTheNextPairHasItToo) {
  const Scene scene(18);
  StereoDepthStage stage(scene.model, scene.parameters);
  const Pair first = mostlyNoise(scene, 1.6), second = mostlyNoise(scene, 1.55);
  const auto expectWaitingThenPose = [&](double stamp, const std::string& where) {
    const StereoDepthResult waiting = stage.process(stamp, first.left, first.right);
    EXPECT_EQ(waiting.failure.reason, Reason::kNotYet) << where << ": " << waiting.failure.message();
    EXPECT_TRUE(waiting.from_search) << where;
    EXPECT_FALSE(waiting.plane.valid()) << where;
    EXPECT_FALSE(waiting.vertical_rotation.known()) << where;
    EXPECT_GT(waiting.points.size(), 20U) << where;
    const StereoDepthResult found = stage.process(stamp + 0.1, second.left, second.right);
    EXPECT_FALSE(found.from_search) << where;
    expectPose(found, makePose(1.55, -8, 0), where);
  };
  expectWaitingThenPose(1, "at the start");
  const cv::Mat black = cv::Mat::zeros(scene.rig.size, CV_8UC1);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(stage.process(2 + 0.1 * i, black, black).failure);
  expectWaitingThenPose(3.5, "after long darkness");
}

TEST(StereoDepthStage, BelievesASearchWithoutDirectRefinementWithTheNextPair) {
  Scene scene(18);
  scene.parameters.direct_refinement = false;
  StereoDepthStage stage(scene.model, scene.parameters);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  EXPECT_EQ(stage.process(1, pair.left, pair.right).failure.reason, Reason::kNotYet);
  expectPose(stage.process(1.1, pair.left, pair.right), makePose(1.6, -8, 0), "the next pair");
}

TEST(StereoDepthStage, KnowsTheSurfaceBelowByCornersAlone) {
  Scene scene(18);
  scene.parameters.direct_refinement = false;
  StereoDepthStage stage(scene.model, scene.parameters);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  stage.process(1, pair.left, pair.right);
  const StereoDepthResult result = stage.process(1.1, pair.left, pair.right);
  ASSERT_FALSE(result.failure) << result.failure.message();
  ASSERT_TRUE(result.below.valid());
  EXPECT_NEAR(result.below.height(), 1.6, 3.5 * std::sqrt(result.below.heightVariance()));
  EXPECT_NEAR(result.curvature, 0, 3.5 * std::sqrt(result.curvature_variance)) << "it is flat";
}

TEST(StereoDepthStage, NamesUniformBlackAndSaturatedImages) {
  const Scene scene(9);
  const Pair good = scene.render(makePose(1.6, -8, 0));
  StereoDepthStage stage(scene.model, scene.parameters);
  double stamp = 0;
  for (const int grey : {0, 128, 255}) {
    const cv::Mat flat(scene.rig.size, CV_8UC1, cv::Scalar(grey));
    EXPECT_EQ(stage.process(stamp += 0.1, flat, flat).failure.reason, Reason::kUniformImage) << grey;
    EXPECT_EQ(stage.process(stamp += 0.1, good.left, flat).failure.reason, Reason::kUniformImage) << grey;
  }
  const StereoDepthResult after = stage.process(stamp + 0.1, good.left, good.right);
  EXPECT_FALSE(after.failure) << after.failure.message();
}

TEST(StereoDepthStage, SaysThatTheImagesAreSwapped) {
  const Scene scene(10);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  StereoDepthStage stage(scene.model, scene.parameters);
  const StereoDepthResult result = stage.process(1, pair.right, pair.left);
  EXPECT_EQ(result.failure.reason, Reason::kNegativeDisparity) << result.failure.message();
  EXPECT_FALSE(result.plane.valid());
  EXPECT_FALSE(stage.process(1.1, pair.left, pair.right).failure) << "once they are put right";
}

/// As cameras upside down see it: turned pictures, left and right exchanged.
Pair upsideDown(const Pair& pair) {
  Pair turned;
  cv::flip(pair.right, turned.left, -1);
  cv::flip(pair.left, turned.right, -1);
  return turned;
}

TEST(StereoDepthStage, SaysThatTheRigMayBeUpsideDownWhenThatStays) {
  const Scene scene(10);
  const Pair pair = scene.render(makePose(1.6, -8, 0)), turned = upsideDown(pair);
  StereoDepthStage stage(scene.model, scene.parameters);
  for (int i = 0; i < 40; ++i) {
    const std::string said = stage.process(0.1 * i, turned.left, turned.right).failure.message();
    if (i < 14) {
      EXPECT_EQ(said, "no_plane: the matches of the pair do not agree on one ground plane") << i;
    } else if (i > 21) {
      EXPECT_EQ(
          said,
          "no_plane: what looks like the ground is above the horizon: if this stays, the cameras may be "
          "mounted upside down: set rig/upside_down: true")
          << i;
    }
  }
  EXPECT_FALSE(stage.process(4, pair.left, pair.right).failure) << "once they are put right";
}

TEST(StereoDepthStage, DoesNotTakeAFlightThatLostTheGroundForOneUpsideDown) {
  const Scene scene(10);
  const Pair pair = scene.render(makePose(1.6, -8, 0)), turned = upsideDown(pair);
  StereoDepthStage stage(scene.model, scene.parameters);
  // As in a hangar, and out of it.
  for (int i = 0; i < 5; ++i) stage.process(0.1 * i, turned.left, turned.right);
  ASSERT_FALSE(stage.process(0.5, pair.left, pair.right).failure);
  for (int i = 6; i < 40; ++i)
    EXPECT_EQ(stage.process(0.1 * i, turned.left, turned.right).failure.message(),
              "no_plane: the matches of the pair do not agree on one ground plane")
        << i;
}

TEST(StereoDepthStage, KeepsSayingThatTheImagesAreSwapped) {
  const Scene scene(10);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  StereoDepthStage stage(scene.model, scene.parameters);
  const cv::Mat black(scene.rig.size, CV_8UC1, cv::Scalar(0));
  stage.process(0, black, black);
  for (int i = 1; i < 4; ++i)
    EXPECT_EQ(stage.process(0.1 * i, pair.right, pair.left).failure.reason, Reason::kNegativeDisparity) << i;
}

TEST(StereoDepthStage, TakesNoZebraBarsOneOffForGroundInFrontWhileTheImagesAreSwapped) {
  for (const double height : {1.2, 1.6, 2.0, 2.5, 3.0}) {
    Scene scene(9);
    scene.ground.bar_period = 0.24;
    scene.ground.bar_from = 1;
    scene.ground.bar_to = 9;
    scene.ground.bar_reach = 3;
    const Pair pair = scene.render(makePose(height, -8, 0));
    EXPECT_EQ(scene.first({pair.right, pair.left}).failure.reason, Reason::kNegativeDisparity) << height;
  }
}

TEST(StereoDepthStage, FindsNoPlaneInImagesThatHaveNothingToDoWithEachOther) {
  const Scene scene(11), other(12);
  const Pose pose = makePose(1.6, -8, 0);
  const StereoDepthResult result = scene.first({scene.render(pose).left, other.render(pose).right});
  EXPECT_TRUE(result.failure);
  EXPECT_NE(result.failure.reason, Reason::kNegativeDisparity);
  EXPECT_FALSE(result.plane.valid());
}

TEST(StereoDepthStage, FindsNoPlaneInNoise) {
  const Scene scene(11);
  cv::Mat left(scene.rig.size, CV_8UC1), right = left.clone();
  cv::RNG(1).fill(left, cv::RNG::UNIFORM, 0, 255);
  cv::RNG(2).fill(right, cv::RNG::UNIFORM, 0, 255);
  EXPECT_TRUE(scene.first({left, right}).failure);
}

TEST(StereoDepthStage, SearchesAnewWhenTheStampDoesNotIncrease) {
  const Scene scene(13);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  for (const double back : {0.0, -5.0}) {
    StereoDepthStage stage(scene.model, scene.parameters);
    EXPECT_TRUE(stage.process(10, pair.left, pair.right).from_search);
    EXPECT_FALSE(stage.process(10.1, pair.left, pair.right).from_search);
    const StereoDepthResult result = stage.process(10.1 + back, pair.left, pair.right);
    EXPECT_FALSE(result.failure);
    EXPECT_TRUE(result.from_search) << back;
    EXPECT_FALSE(stage.process(10.2 + back, pair.left, pair.right).from_search);
  }
  StereoDepthStage stage(scene.model, scene.parameters);
  stage.process(1, pair.left, pair.right);
  stage.reset();
  EXPECT_TRUE(stage.process(2, pair.left, pair.right).from_search);
}

TEST(StereoDepthStage, AfterAResetAPairIsSeenAsByANewStage) {
  const Scene scene(13);
  const Pair pair = scene.render(makePose(1.6, -8, 0)), swapped{pair.right, pair.left};
  StereoDepthStage stage(scene.model, scene.parameters);
  for (int i = 0; i < 3; ++i) stage.process(1 + 0.1 * i, swapped.left, swapped.right);
  for (int i = 3; i < 8; ++i) stage.process(1 + 0.1 * i, pair.left, pair.right);
  stage.reset();
  const StereoDepthResult result = stage.process(1.8, pair.left, pair.right), first = scene.first(pair);
  EXPECT_FALSE(result.left_repeated || result.right_repeated);
  EXPECT_EQ(result.from_search, first.from_search);
  EXPECT_EQ(result.plane.g, first.plane.g);
  EXPECT_EQ(result.plane.covariance, first.plane.covariance);
  EXPECT_EQ(result.row_covariance, first.row_covariance);
  EXPECT_EQ(result.vertical_rotation.w, first.vertical_rotation.w);
}

TEST(StereoDepthStage, FindsThePlaneAgainAfterAJump) {
  // As when a bag is cut: the next pair shows another height with an increasing stamp.
  const Scene scene(14);
  StereoDepthStage stage(scene.model, scene.parameters);
  const Pair high = scene.render(makePose(3, -8, 0));
  stage.process(1, high.left, high.right);
  const Pose pose = makePose(0.7, -8, 0);
  const Pair low = scene.render(pose);
  expectPose(stage.process(2, low.left, low.right), pose, "jump");
}

/// Sinks for half a second in which the plane moves on as expected.
double sinkSteadily(const Scene& scene, StereoDepthStage& stage) {
  double stamp = 1;
  for (int i = 0; i < 6; ++i, stamp += 0.1) {
    const Pose pose = makePose(2.1 - 0.02 * i, -8, 0);
    const Pair pair = scene.render(pose);
    expectPose(stage.process(stamp, pair.left, pair.right), pose, "steady");
  }
  return stamp;
}

/// Points on the plane in the uppermost rows of the ground.
int pointsBelowHorizon(const Scene& scene, const Pose& pose, const StereoDepthResult& result) {
  constexpr double kRows = 32;
  const double horizon = scene.rig.cy + scene.rig.fy * std::tan(pose.pitch);
  return static_cast<int>(std::count_if(
      result.points.begin(), result.points.end(),
      [&](const StereoDepthResult::Point& point) { return point.on_plane && point.v < horizon + kRows; }));
}

// Rows of sky are not made ready for matching. With each pair 44 of them become ground.
TEST(StereoDepthStage, SeesTheGroundThatComesIntoViewWhileTheNoseGoesDownSteadily) {
  Scene scene(14, 0.05);
  scene.rig = test::makeRig(640, 480, 1.0);
  scene.model = test::makeModel(scene.rig);
  StereoDepthStage stage(scene.model, scene.parameters);
  for (int i = 0; i < 6; ++i) {
    const Pose pose = makePose(5, 10 - 5 * i, 0);
    const Pair pair = scene.render(pose);
    const int seen = pointsBelowHorizon(scene, pose, stage.process(1 + 0.1 * i, pair.left, pair.right));
    EXPECT_GT(seen, pointsBelowHorizon(scene, pose, scene.first(pair)) / 2) << i;
    EXPECT_GT(seen, 10) << i;
  }
}

TEST(StereoDepthStage, FindsThePlaneAgainAfterAJumpFromSteadyFlight) {
  const Scene scene(14);
  for (const double height : {2.05, 1.9, 1.6, 0.7}) {
    StereoDepthStage stage(scene.model, scene.parameters);
    const double stamp = sinkSteadily(scene, stage);
    const Pose pose = makePose(height, -9, 1);
    const Pair pair = scene.render(pose);
    expectPose(stage.process(stamp, pair.left, pair.right), pose, "jump");
  }
}

TEST(StereoDepthStage, HasNoPlaneOfAPairThatDoesNotMatchAfterSteadyFlight) {
  const Scene scene(14), elsewhere(99);
  StereoDepthStage stage(scene.model, scene.parameters);
  const double stamp = sinkSteadily(scene, stage);
  const Pose pose = makePose(1.98, -8, 0);
  const StereoDepthResult result =
      stage.process(stamp, scene.render(pose).left, elsewhere.render(pose).right);
  EXPECT_TRUE(result.failure);
  EXPECT_FALSE(result.plane.valid());
  for (const StereoDepthResult::Point& point : result.points) EXPECT_FALSE(point.on_plane);
}

TEST(StereoDepthStage, RefusesAnotherSize) {
  const Scene scene(15);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  StereoDepthStage stage(scene.model, scene.parameters);
  const cv::Mat small = pair.right(cv::Rect(0, 0, 300, 240)).clone();
  EXPECT_EQ(stage.process(1, pair.left, small).failure.reason, Reason::kInputInvalid);
  EXPECT_EQ(stage.process(2, small, pair.right).failure.reason, Reason::kInputInvalid);
  EXPECT_EQ(stage.process(3, cv::Mat(), pair.right).failure.reason, Reason::kInputInvalid);
  EXPECT_FALSE(stage.process(4, pair.left, pair.right).failure);
}

TEST(StereoDepthStage, LooksInsideTheMasksOnly) {
  Scene scene(16);
  const cv::Rect inside(50, 40, 220, 190);
  scene.model.left_mask = 0;
  scene.model.right_mask = 0;
  scene.model.left_mask(inside) = 255;
  scene.model.right_mask(inside) = 255;
  const Pose pose = makePose(2.5, -8, 0);
  Pair pair = scene.render(pose);
  // Garbage where rectification has no picture, the same in both, as lens borders are.
  cv::Mat garbage(scene.rig.size, CV_8UC1);
  cv::RNG(5).fill(garbage, cv::RNG::UNIFORM, 0, 255);
  garbage.copyTo(pair.left, 255 - scene.model.left_mask);
  garbage.copyTo(pair.right, 255 - scene.model.right_mask);
  const StereoDepthResult result = scene.first(pair);
  expectPose(result, pose, "mask");
  for (const StereoDepthResult::Point& point : result.points) {
    EXPECT_TRUE(inside.contains(cv::Point(cvRound(point.u), cvRound(point.v))));
    const double column = point.u - point.disparity - scene.rig.principalOffset();
    EXPECT_TRUE(inside.contains(cv::Point(cvRound(column), cvRound(point.v))));
  }
}

/// Flies over the ground for two seconds, with a nose of strong edges in view or without. speed: m/s.
struct Flight {
  double own_frame = 0;            // at the end
  int on_nose = 0, on_ground = 0;  // of the last pair's corners, those on the nose, and those on the plane
  Flight(double speed, bool has_nose, bool reset = false) {
    const Scene scene(31);
    const cv::Rect nose(110, 192, 96, 48);
    cv::Mat picture(nose.size(), CV_8UC1);
    cv::RNG(3).fill(picture, cv::RNG::UNIFORM, 0, 255);
    cv::resize(picture, picture, {}, 0.25, 0.25, cv::INTER_AREA);
    cv::normalize(picture, picture, 60, 160, cv::NORM_MINMAX);
    cv::resize(picture, picture, nose.size(), 0, 0, cv::INTER_NEAREST);
    StereoDepthStage stage(scene.model, scene.parameters);
    for (int i = 0; i < 20; ++i) {
      Pose pose = makePose(1.6, -8, 0);
      pose.position.x() = 0.1 * i * speed;
      Pair pair = scene.render(pose);
      if (has_nose) picture.copyTo(pair.left(nose));
      const StereoDepthResult result = stage.process(0.1 * i, pair.left, pair.right);
      EXPECT_FALSE(result.failure) << i << ": " << result.failure.message();
      on_nose = on_ground = 0;
      for (const StereoDepthResult::Point& point : result.points) {
        on_nose += nose.contains(cv::Point(cvRound(point.u), cvRound(point.v)));
        on_ground += point.on_plane;
      }
    }
    if (reset) stage.reset();
    own_frame = stage.ownFrame();
  }
};

TEST(StereoDepthStage, LearnsWhatDoesNotMoveWithTheGround) {
  const Flight clear(2, false), with_nose(2, true);
  EXPECT_EQ(clear.own_frame, 0);
  EXPECT_GT(with_nose.own_frame, 0.5 * 96 * 48 / (320 * 240.));
  EXPECT_LT(with_nose.own_frame, 1.1 * 96 * 48 / (320 * 240.));
  EXPECT_EQ(with_nose.on_nose, 0);
  EXPECT_GT(with_nose.on_ground, Flight(0, true).on_ground) << "its corners are on the ground instead";
}

TEST(StereoDepthStage, LearnsNothingWhileItStandsStillAndForgetsWithAReset) {
  EXPECT_EQ(Flight(0, true).own_frame, 0);
  EXPECT_EQ(Flight(2, true, true).own_frame, 0);
}

TEST(StereoDepthStage, PassesStampAndSkewOnAndIsDeterministic) {
  const Scene scene(17);
  const Pair pair = scene.render(makePose(1.6, -8, 0));
  StereoDepthStage a(scene.model, scene.parameters), b(scene.model, scene.parameters);
  const StereoDepthResult first = a.process(12.5, pair.left, pair.right, 0.004);
  const StereoDepthResult second = b.process(99, pair.left, pair.right);
  EXPECT_EQ(first.stamp, 12.5);
  EXPECT_EQ(first.skew, 0.004);
  EXPECT_EQ(first.plane.g, second.plane.g);
  EXPECT_EQ(first.plane.covariance, second.plane.covariance);
  EXPECT_FALSE(a.timings().parts().empty());
}

TEST(StereoDepthStage, MeasuresDisparitiesThatAreThoseOfTheGround) {
  const Scene scene(18);
  const Pose pose = makePose(1.6, -8, 5);
  const StereoDepthResult result = scene.first(scene.render(pose));
  ASSERT_FALSE(result.failure);
  const GroundPlane truth = test::exactPlane(pose, 0, 0);
  ASSERT_GT(result.points.size(), 100U);
  double normalised = 0;
  int good = 0;
  for (const StereoDepthResult::Point& point : result.points) {
    const double error = point.disparity - truth.disparity(scene.rig, point.u, point.v);
    if (std::abs(error) > 0.5) continue;
    ++good;
    normalised += std::pow(error / point.disparity_stddev, 2);
  }
  EXPECT_GT(good, 0.9 * static_cast<double>(result.points.size()));
  const double ratio = std::sqrt(normalised / good);
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2);
}

}  // namespace
}  // namespace uav_landing
