#include "image/input/image_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "image/windows/match_image.h"
#include "support/ground_renderer.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

cv::Mat striped(const cv::Size& size) {
  cv::Mat image(size, CV_8UC1, cv::Scalar(90));
  for (int u = 0; u < size.width; u += 8) image.colRange(u, std::min(u + 4, size.width)) = 140;
  return image;
}

TEST(CheckPair, HasNothingAgainstAPicture) {
  const RigModel model = test::makeModel(test::makeRig(80, 60, 0.5));
  EXPECT_FALSE(checkPair(model, striped({80, 60}), striped({80, 60})));
}

TEST(CheckPair, RefusesAnotherSizeOrTypeAndNamesTheSide) {
  const RigModel model = test::makeModel(test::makeRig(80, 60, 0.5));
  const cv::Mat good = striped({80, 60});
  cv::Mat colour;
  cv::merge(std::vector<cv::Mat>{good, good, good}, colour);
  for (const cv::Mat& bad : {striped({80, 61}), striped({60, 80}), cv::Mat(), colour}) {
    const Failure left = checkPair(model, bad, good), right = checkPair(model, good, bad);
    EXPECT_EQ(left.reason, Reason::kInputInvalid);
    EXPECT_EQ(right.reason, Reason::kInputInvalid);
    EXPECT_EQ(left.detail.find("left"), 0U) << left.detail;
    EXPECT_EQ(right.detail.find("right"), 0U) << right.detail;
  }
  const Failure size = checkPair(model, good, striped({100, 61}));
  EXPECT_NE(size.detail.find("100 x 61"), std::string::npos) << size.detail;
  EXPECT_NE(size.detail.find("80 x 60"), std::string::npos) << size.detail;
}

TEST(CheckPair, RefusesBlackSaturatedAndUniformImages) {
  const RigModel model = test::makeModel(test::makeRig(80, 60, 0.5));
  const cv::Mat good = striped({80, 60});
  for (const int grey : {0, 128, 255}) {
    const cv::Mat flat(60, 80, CV_8UC1, cv::Scalar(grey));
    EXPECT_EQ(checkPair(model, flat, good).reason, Reason::kUniformImage) << grey;
    EXPECT_EQ(checkPair(model, good, flat).reason, Reason::kUniformImage) << grey;
  }
}

TEST(CheckPair, LooksInsideTheMaskOnly) {
  RigModel model = test::makeModel(test::makeRig(80, 60, 0.5));
  const cv::Rect inside(10, 8, 50, 40);
  model.left_mask = 0;
  model.left_mask(inside) = 255;
  cv::Mat image = striped({80, 60});
  EXPECT_FALSE(checkPair(model, image, image));
  cv::Mat blind = image.clone();
  blind(inside) = 100;  // contrast is left where there is no picture
  EXPECT_EQ(checkPair(model, blind, image).reason, Reason::kUniformImage);
}

TEST(ErodeMask, LeavesWindowsThatLieWhollyInside) {
  cv::Mat mask(60, 80, CV_8UC1, cv::Scalar(255));
  mask.at<uchar>(30, 40) = 0;
  constexpr int kMargin = 5;
  const cv::Mat eroded = erodeMask(mask, kMargin);
  for (int v = 0; v < 60; ++v)
    for (int u = 0; u < 80; ++u) {
      const bool border = u < kMargin || v < kMargin || u >= 80 - kMargin || v >= 60 - kMargin;
      const bool hole = std::abs(u - 40) <= kMargin && std::abs(v - 30) <= kMargin;
      ASSERT_EQ(eroded.at<uchar>(v, u) != 0, !border && !hole) << u << " " << v;
    }
}

TEST(MatchImage, HasACoarseLevelWhoseCoordinatesAreThoseOfTheFullSize) {
  // A bright spot around (401, 203): its centre of mass at the coarse level, carried back, must be the same.
  cv::Mat image(480, 1280, CV_8UC1, cv::Scalar(0));
  cv::circle(image, {401, 203}, 12, cv::Scalar(200), cv::FILLED);
  MatchImage match;
  match.assign(image);
  ASSERT_GT(match.factor, 1);
  ASSERT_EQ(match.fine.size(), image.size());
  ASSERT_EQ(match.coarse.cols, image.cols / match.factor);
  const cv::Moments coarse = cv::moments(match.coarse), fine = cv::moments(match.fine);
  EXPECT_NEAR(fine.m10 / fine.m00, 401, 1e-3);
  EXPECT_NEAR(fine.m01 / fine.m00, 203, 1e-3);
  EXPECT_NEAR(fromCoarse(coarse.m10 / coarse.m00, match.factor), 401, 0.02);
  EXPECT_NEAR(fromCoarse(coarse.m01 / coarse.m00, match.factor), 203, 0.02);
  EXPECT_NEAR(toCoarse(fromCoarse(17.25, match.factor), match.factor), 17.25, 1e-12);
}

TEST(MatchImage, MayBeReusedForImagesOfAnotherSize) {
  MatchImage match, fresh;
  match.assign(striped({320, 240}));
  EXPECT_EQ(match.factor, 1);
  const cv::Mat large = striped({960, 640});
  match.assign(large);
  fresh.assign(large);
  EXPECT_EQ(match.factor, fresh.factor);
  EXPECT_EQ(cv::norm(match.fine, fresh.fine, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(match.coarse, fresh.coarse, cv::NORM_INF), 0);
}

TEST(MatchImage, LeavesRowsOutUntilTheyAreAdded) {
  for (const cv::Size size : {cv::Size(960, 640), cv::Size(320, 240)}) {
    const cv::Mat image = striped(size);
    MatchImage all, match;
    all.assign(image);
    match.assign(cv::Mat(size, CV_8UC1, cv::Scalar(200)));
    match.assign(image, {101, 47});
    const int fine = match.factor == 1 ? 47 : 101;
    const auto differ = [](const cv::Mat& a, const cv::Mat& b, int begin, int end) {
      return cv::norm(a.rowRange(begin, end), b.rowRange(begin, end), cv::NORM_INF) > 0;
    };
    EXPECT_FALSE(differ(match.fine, all.fine, fine, size.height));
    EXPECT_FALSE(differ(match.coarse, all.coarse, 47, all.coarse.rows));
    EXPECT_TRUE(differ(match.fine, all.fine, 0, fine));
    EXPECT_TRUE(differ(match.coarse, all.coarse, 0, 47));
    match.extend(image, {120, 60});
    EXPECT_TRUE(differ(match.fine, all.fine, 0, fine));
    EXPECT_EQ(match.first.fine, fine) << "fewer rows than there are take none away";
    if (match.factor > 1) {
      EXPECT_EQ(match.first.coarse, 47);
    }
    match.extend(image, {});
    EXPECT_FALSE(differ(match.fine, all.fine, 0, size.height));
    EXPECT_FALSE(differ(match.coarse, all.coarse, 0, all.coarse.rows));
  }
}

TEST(RepeatedImage, IsTheOneBeforeBitByBitAndNoOlderOne) {
  RepeatedImage repeated;
  const cv::Mat first = striped({80, 60});
  cv::Mat second = first.clone();
  second.at<uchar>(16, 40) ^= 1;  // one bit, in a row that is looked at
  EXPECT_FALSE(repeated.check(first)) << "nothing was before it";
  EXPECT_TRUE(repeated.check(first.clone()));
  EXPECT_TRUE(repeated.check(first.clone())) << "a third time";
  EXPECT_FALSE(repeated.check(second));
  EXPECT_TRUE(repeated.check(second.clone()));
  EXPECT_FALSE(repeated.check(first)) << "the one before the last";
  EXPECT_FALSE(repeated.check(first.colRange(0, 40)));
  EXPECT_FALSE(repeated.check(cv::Mat(60, 40, CV_16UC1, cv::Scalar(90))));
  repeated.reset();
  EXPECT_FALSE(repeated.check(first));
  repeated.reset();
  EXPECT_FALSE(repeated.check(first)) << "after a reset nothing was before it";
}

TEST(RepeatedImage, KeepsNoReferenceToTheBufferOfTheDriver) {
  RepeatedImage repeated;
  cv::Mat buffer = striped({80, 60});
  repeated.check(buffer);
  buffer.at<uchar>(8, 8) ^= 1;
  EXPECT_FALSE(repeated.check(buffer)) << "the driver has filled the same buffer with the next image";
}

TEST(FirstGroundRows, AreAboveTheHorizonEverywhere) {
  StereoRig rig;
  rig.size = {640, 480};
  rig.fx = rig.fy = 500;
  rig.cx = rig.cx_right = 319.5;
  rig.cy = 239.5;
  rig.baseline = 1;
  // 5 degrees down, right side 10 degrees down: the ground reaches highest on the right, where its horizon is
  // tan(10 deg) higher for each column from the middle.
  const double degree = M_PI / 180;
  const double middle = 239.5 - 500 * std::tan(5 * degree) / std::cos(10 * degree);
  const double highest = middle - 319.5 * std::tan(10 * degree);
  const Eigen::Vector3d normal = 0.02 * normalFromPitchRoll(-5 * degree, 10 * degree);
  const FirstRows rows = firstGroundRows(rig, normal, {20, 10}, 0.02);
  EXPECT_NEAR(rows.fine, highest - 0.02 * 480 - 20, 1.5);
  EXPECT_NEAR(rows.coarse, (highest - 0.02 * 480) / 2 - 10, 1.5);
  // Looking up by so much that there is none, and down by so much that there is nothing else.
  EXPECT_GE(firstGroundRows(rig, normalFromPitchRoll(40 * degree, 0), {0, 0}, 0).fine, 480);
  EXPECT_EQ(firstGroundRows(rig, normalFromPitchRoll(-40 * degree, 0), {0, 0}, 0).fine, 0);
  EXPECT_EQ(firstGroundRows(rig, {0, -1, 0}, {0, 0}, 0).fine, 0);
}

}  // namespace
}  // namespace uav_landing
