#include "image/input/learned_frame.h"

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace uav_landing {
namespace {

const cv::Size kSize(160, 120);
const cv::Rect kNose(48, 80, 64, 40);
constexpr double kPeriod = 0.1;  // s

/// Blobs of some pixels, with strong edges.
cv::Mat texture(cv::Size size, int seed) {
  cv::Mat image(size, CV_32F);
  cv::RNG(seed).fill(image, cv::RNG::NORMAL, 128, 200);
  cv::GaussianBlur(image, image, {}, 1.5);
  return image;
}

/// Ground that moves down the picture, with something in front of it.
struct Scene {
  double speed = 20;   // px/s
  int still_rows = 0;  // of the ground, from the top
  cv::Rect nose = kNose;
  cv::Mat nose_picture = texture(kNose.size(), 2);
  /// Whether a corner at a place is looked for, and found on the ground.
  std::function<bool(const cv::Point&)> looked_for = [](const cv::Point&) { return true; };
  std::function<bool(const cv::Point&)> found = [this](const cv::Point& at) { return !nose.contains(at); };

  cv::Mat at(double t) const {
    static const cv::Mat ground = texture({kSize.width, 2000}, 1);
    const int moved = cvRound(speed * t);
    cv::Mat picture = ground.rowRange(1000 - moved, 1000 - moved + kSize.height).clone(),
            noise(kSize, CV_32F);
    if (still_rows > 0) ground.rowRange(0, still_rows).copyTo(picture.rowRange(0, still_rows));
    if (!nose.empty()) nose_picture.copyTo(picture(nose));
    cv::RNG(static_cast<uint64>(1000 * t + 7)).fill(noise, cv::RNG::NORMAL, 0, 1);
    cv::Mat result;
    cv::Mat(picture + noise).convertTo(result, CV_8U);
    return result;
  }

  void show(LearnedFrame& frame, double from, double to) const {
    std::vector<cv::Point> tried, on_ground;
    for (int v = 3; v < kSize.height; v += 6)
      for (int u = 3; u < kSize.width; u += 6) {
        if (!looked_for({u, v})) continue;
        tried.emplace_back(u, v);
        if (found({u, v})) on_ground.emplace_back(u, v);
      }
    for (double t = from; t < to; t += kPeriod) frame.observe(t, at(t), tried, on_ground);
  }
  double shareAfter(double seconds) const {
    LearnedFrame frame(kSize);
    show(frame, 0, seconds);
    return frame.share();
  }
};

cv::Mat leftOut(LearnedFrame frame, int margin = 0) {
  const cv::Mat mask(kSize, CV_8U, cv::Scalar(255));
  return frame.leftOut(mask, margin) == 0;
}

TEST(LearnedFrame, IsWhatStaysWhileTheGroundMoves) {
  const Scene scene;
  LearnedFrame frame(kSize);
  scene.show(frame, 0, 2);
  cv::Mat expected(kSize, CV_8U, cv::Scalar(0));
  expected(kNose) = 255;
  EXPECT_EQ(cv::countNonZero(leftOut(frame) != expected), 0);
  EXPECT_DOUBLE_EQ(frame.share(), kNose.area() / static_cast<double>(kSize.area()));
}

TEST(LearnedFrame, IsJudgedByTheGroundNearItAlone) {
  // Ground near the horizon stays.
  Scene scene;
  scene.still_rows = 32;
  LearnedFrame frame(kSize);
  scene.show(frame, 0, 2);
  EXPECT_EQ(cv::countNonZero(leftOut(frame)(kNose)), kNose.area());
}

TEST(LearnedFrame, IsNotWhereNoCornerWasLookedFor) {
  // As along an edge of the runway straight ahead, which looks the same all the time.
  Scene scene;
  scene.looked_for = [](const cv::Point& at) { return !kNose.contains(at); };
  EXPECT_EQ(scene.shareAfter(4), 0);
}

TEST(LearnedFrame, TakesAboutASecond) {
  const Scene scene;
  EXPECT_EQ(scene.shareAfter(0.9), 0);
  EXPECT_GT(scene.shareAfter(1.4), 0);
}

TEST(LearnedFrame, NothingIsWhileTheCameraStandsStill) {
  Scene scene;
  scene.speed = 0;
  EXPECT_EQ(scene.shareAfter(4), 0);
}

TEST(LearnedFrame, GroundWhoseCornersAreFoundIsNotEvenWhereItStays) {
  // As around the point that the aircraft flies to.
  Scene scene;
  scene.found = [](const cv::Point&) { return true; };
  EXPECT_EQ(scene.shareAfter(4), 0);
}

TEST(LearnedFrame, GroundWhoseCornersAreNotFoundIsNotAsItMoves) {
  // As bars that repeat.
  Scene scene;
  scene.nose = {};
  scene.found = [](const cv::Point& at) { return !kNose.contains(at); };
  EXPECT_EQ(scene.shareAfter(4), 0);
}

TEST(LearnedFrame, WhatIsFarIsNotAsTheGroundAroundItStaysToo) {
  Scene scene;
  scene.still_rows = 72;
  scene.nose = {};
  scene.found = [](const cv::Point& at) { return at.x > 60 || at.y > 72; };
  EXPECT_EQ(scene.shareAfter(4), 0);
}

TEST(LearnedFrame, SkyIsNot) {
  Scene scene;
  scene.still_rows = 72;
  scene.found = [](const cv::Point& at) { return at.y > 72 && !kNose.contains(at); };
  LearnedFrame frame(kSize);
  scene.show(frame, 0, 4);
  EXPECT_EQ(cv::countNonZero(leftOut(frame).rowRange(0, 72)), 0);
}

TEST(LearnedFrame, APatchWithoutTextureIsNot) {
  // As asphalt, of which only noise is seen.
  Scene scene;
  scene.nose_picture = cv::Mat(kNose.size(), CV_32F, cv::Scalar(100));
  cv::Mat inside = leftOut([&] {
    LearnedFrame frame(kSize);
    scene.show(frame, 0, 4);
    return frame;
  }());
  const cv::Rect patch(kNose.x + 8, kNose.y + 8, kNose.width - 16, kNose.height - 8);
  EXPECT_EQ(cv::countNonZero(inside(patch)), 0);
}

TEST(LearnedFrame, ComesBackWhenItsContentMoves) {
  Scene scene;
  LearnedFrame frame(kSize);
  scene.show(frame, 0, 2);
  ASSERT_FALSE(frame.empty());
  scene.nose = {};
  scene.show(frame, 2, 2.5);
  EXPECT_TRUE(frame.empty());
}

TEST(LearnedFrame, StaysLearnedWhileNoCornerIsTriedInItAndTheCameraStandsStill) {
  Scene scene;
  LearnedFrame frame(kSize);
  scene.show(frame, 0, 2);
  const double share = frame.share();
  ASSERT_GT(share, 0);
  const cv::Mat last = scene.at(2);
  for (double t = 2; t < 5; t += kPeriod) frame.observe(t, last, {}, {});
  EXPECT_EQ(frame.share(), share);
}

TEST(LearnedFrame, IsForgottenWhenTheClockIsSetOrAfterAGap) {
  const Scene scene;
  for (const double next : {1.0, 3.5}) {
    LearnedFrame frame(kSize);
    scene.show(frame, 0, 2);
    ASSERT_FALSE(frame.empty());
    frame.observe(next, scene.at(2), {}, {});
    EXPECT_TRUE(frame.empty()) << next;
  }
}

TEST(LearnedFrame, IsLeftOutWithAMargin) {
  const Scene scene;
  LearnedFrame frame(kSize);
  scene.show(frame, 0, 2);
  cv::Mat expected;
  cv::dilate(leftOut(frame), expected, cv::Mat::ones(11, 11, CV_8U));
  EXPECT_EQ(cv::countNonZero(leftOut(frame, 5) != expected), 0);
}

}  // namespace
}  // namespace uav_landing
