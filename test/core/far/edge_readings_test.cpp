#include "far/edge_readings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "runway_picture.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

RunwayPose poseAt(double x) { return {{x, 15, -x * 0.055}, 2 * kDegree, -3 * kDegree, 1 * kDegree}; }

/// Pairs that see a runway from the same place, each with noise of its own.
class Pairs {
 public:
  Pairs(const RunwayPicture& picture, double x)
      : picture_(picture),
        pose_(poseAt(x)),
        corners_(*cornersOf(pose_, {picture.width, picture.length}, picture.rig())),
        start_(corners_) {}

  void startFrom(const Vector8d& inward) { start_ = movedBy(corners_, inward); }

  /// Errors of the sides by a fit from the start alone, px inward.
  Vector8d byOneFit() const {
    const cv::Mat mask(picture_.size, CV_8U, cv::Scalar(255));
    const auto fitted = OutlineFitter(picture_.render(pose_, 1), mask, start_, lookOf(picture_))
                            .fit(Vector8d::Zero(), EdgePaint::kNone);
    return fitted->seen.inward - movedInward(fitted->seen.reference, corners_);
  }

  /// Errors of the sides after this many more pairs, px inward, and the last covariance.
  Vector8d after(int pairs) {
    const cv::Mat mask(picture_.size, CV_8U, cv::Scalar(255));
    for (int i = 0; i < pairs; ++i) {
      const auto outline = readings_.fit(picture_.render(pose_, ++seed_), mask, start_, lookOf(picture_));
      if (!outline) {
        ADD_FAILURE() << outline.error().message();
        break;
      }
      start_ = outline->corners;
      last = outline->fitted;
    }
    return last.seen.inward - movedInward(last.seen.reference, corners_);
  }

  /// Error of the width at the near end and its claim, px.
  double widthError(const Vector8d& errors) const { return -errors[0] - errors[5]; }
  double widthStddev() const {
    const Matrix8d& c = last.seen.covariance;
    return std::sqrt(c(0, 0) + c(5, 5) + 2 * c(0, 5));
  }

  FittedOutline last;

 private:
  RunwayPicture picture_;
  RunwayPose pose_;
  Corners corners_, start_;
  EdgeReadings readings_;
  unsigned seed_ = 0;
};

/// A surface that is hardly darker than the ground: a stripe outshines it, and looks like the ground.
RunwayPicture faintRunway(bool painted) {
  RunwayPicture picture;
  picture.width = 34;
  picture.length = 1600;
  picture.surface = 80;
  picture.ground = 100;
  picture.bars = 0;
  picture.stripe = painted ? 0.7 : 0;
  picture.inset = 1.1;
  return picture;
}

TEST(EdgeReadings, FromAfarTheClaimHoldsBothReadings) {
  for (const bool painted : {true, false}) {
    Pairs pairs(faintRunway(painted), -2500);
    const double error = pairs.widthError(pairs.after(9));
    EXPECT_LT(std::abs(error), 2.5 * pairs.widthStddev()) << painted;
    // 0.7 m of paint, 120 grey levels over surface 20 darker than the ground: 4 m of each side, if it is
    // there.
    const double pixel = 2500 / 554.0;
    EXPECT_GT(pairs.widthStddev() * pixel, 8.0 / 5) << "m, " << painted;
  }
}

TEST(EdgeReadings, OnABrightRunwayToo) {
  for (const bool painted : {true, false}) {
    RunwayPicture bright = faintRunway(painted);
    bright.surface = 120;
    Pairs pairs(bright, -2000);
    const double error = pairs.widthError(pairs.after(9));
    EXPECT_LT(std::abs(error), 2.5 * pairs.widthStddev()) << painted;
    EXPECT_LT(std::abs(error) * 2000 / 554.0, 0.12 * 34) << painted;
  }
}

TEST(EdgeReadings, FromNearTheTrueReadingWins) {
  for (const bool painted : {true, false}) {
    Pairs pairs(faintRunway(painted), -500);
    const double error = pairs.widthError(pairs.after(9));
    const double pixel = 500 / 554.0;
    EXPECT_LT(std::abs(error) * pixel, 0.05 * 34) << painted;
    EXPECT_LT(pairs.widthStddev() * pixel, 0.05 * 34) << painted;
    EXPECT_LT(std::abs(error), 3 * pairs.widthStddev()) << painted;
  }
}

/// Beside a clear edge the image hides stripes that are narrower than a pixel: a dark margin and a bright
/// stripe together look like the ground.
TEST(EdgeReadings, StripesThatLookLikeTheGroundAreInTheClaim) {
  RunwayPicture narrow;
  narrow.width = 28;
  narrow.length = 1400;
  narrow.surface = 52;
  narrow.paint = 166;
  narrow.stripe = narrow.inset = 0.6;
  for (const double x : {-1000.0, -650.0}) {
    Pairs pairs(narrow, x);
    const double error = pairs.widthError(pairs.after(9));
    EXPECT_LT(std::abs(error), 2.5 * pairs.widthStddev()) << x;
  }
}

TEST(EdgeReadings, AnEndThatBeganElsewhereIsFound) {
  // Beyond the first fit's reach: the near end 7.5 px too near, the far one 5.5 px too far.
  // Noise moves it between the threshold and the bars, so it is the mean that has to be right.
  constexpr int kPairs = 10;
  RunwayPicture picture;
  for (const auto& [side, shift] : {std::pair{kNearSide, -7.5}, {kFarSide, -5.5}}) {
    Pairs pairs(picture, -1200);
    Vector8d inward = Vector8d::Zero();
    inward.segment<2>(2 * side).setConstant(shift);
    pairs.startFrom(inward);
    EXPECT_GT(pairs.byOneFit().segment<2>(2 * side).cwiseAbs().maxCoeff(), 1.5) << side;
    Vector8d mean = pairs.after(13) / kPairs;
    for (int i = 1; i < kPairs; ++i) mean += pairs.after(1) / kPairs;
    EXPECT_LT(mean.segment<2>(2 * side).cwiseAbs().maxCoeff(), 1.5) << side;
  }
}

TEST(EdgeReadings, WithoutAnOutlineItSaysWhy) {
  RunwayPicture bare;
  bare.surface = bare.paint = bare.ground;
  EdgeReadings readings;
  const RunwayPose pose = poseAt(-2000);
  const auto outline = readings.fit(bare.render(pose), cv::Mat(bare.size, CV_8U, cv::Scalar(255)),
                                    *cornersOf(pose, {45, 2500}, bare.rig()), lookOf(bare));
  ASSERT_FALSE(outline);
  EXPECT_EQ(outline.error().reason, Reason::kNoRunway);
}

}  // namespace
}  // namespace uav_landing
