#include "far/outline_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runway_picture.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

RunwayPose poseAt(double x, double height) {
  return {{x, 15, height}, 2 * kDegree, -3 * kDegree, 1 * kDegree};
}

/// The fit from corners that are some tenths of a pixel off, and the true ones.
struct Fit {
  Corners corners;
  Expected<FittedOutline> found;

  Fit(const RunwayPicture& picture, const RunwayPose& pose)
      : corners(*cornersOf(pose, {picture.width, picture.length}, picture.rig())),
        found(tl::make_unexpected(Failure())) {
    const cv::Mat image = picture.render(pose);
    Corners start = corners;
    for (int i = 0; i < kSides; ++i)
      start[i] += Eigen::Vector2d(0.7 * std::sin(5 * i + 1), 0.7 * std::cos(3 * i));
    found = fitOutline(image, cv::Mat(image.size(), CV_8U, cv::Scalar(255)), start, lookOf(picture));
  }
  Vector8d errors() const { return found->seen.inward - movedInward(found->seen.reference, corners); }
};

TEST(OutlineFit, FindsTheSidesOfASurfaceWithoutMarks) {
  RunwayPicture picture;
  picture.stripe = picture.bars = 0;
  for (const double x : {-3500.0, -2000.0, -900.0}) {
    const Fit fit(picture, poseAt(x, -x * 0.055));
    ASSERT_TRUE(fit.found) << fit.found.error().message();
    for (int i = 0; i < 8; ++i)
      EXPECT_LT(std::abs(fit.errors()[i]), 3.5 * std::sqrt(fit.found->seen.covariance(i, i)) + 0.02)
          << x << ", " << i;
    // The noise of 2 grey levels over hundreds of pixels, and 0.1 px by what is not known of the surface. At
    // an end 15 m of marks may hide where the surface begins.
    const double height = -x * 0.055;
    const double hidden = picture.focal * height * (1 / -x - 1 / (15 - x));
    for (int i = 0; i < 8; ++i) {
      const bool at_end = i / 2 == kNearSide || i / 2 == kFarSide;
      EXPECT_LT(std::sqrt(fit.found->seen.covariance(i, i)), std::hypot(0.4, at_end ? hidden : 0))
          << x << ", " << i;
    }
    EXPECT_NEAR(fit.found->contrast, picture.surface - picture.ground, 8);
  }
}

TEST(OutlineFit, IsNotMisledByStripesAndBarsThatAreNarrowerThanAPixel) {
  // A stripe of 0.9 m, at 2 km: a quarter of a pixel, but 135 grey levels over a surface 35 darker than the
  // ground. It would move each edge by 0.9 px without being seen by itself.
  const RunwayPicture picture;
  double squares = 0;
  for (const double x : {-2500.0, -2000.0, -1200.0}) {
    const Fit fit(picture, poseAt(x, -x * 0.055));
    ASSERT_TRUE(fit.found) << fit.found.error().message();
    const Vector8d errors = fit.errors();
    for (int i = 0; i < 8; ++i)
      EXPECT_LT(std::abs(errors[i]), 4.5 * std::sqrt(fit.found->seen.covariance(i, i)) + 0.05)
          << x << ", " << i;
    const double width = errors[2 * kLeftSide] + errors[2 * kRightSide + 1];
    squares += width * width / 3;
  }
  EXPECT_LT(std::sqrt(squares), 0.5) << "of the width at the near end, px";
}

TEST(OutlineFit, SaysThatThereIsNoContrast) {
  RunwayPicture picture;
  picture.stripe = picture.bars = 0;
  picture.surface = picture.ground;
  const Fit fit(picture, poseAt(-2000, 110));
  ASSERT_FALSE(fit.found);
  EXPECT_EQ(fit.found.error().reason, Reason::kNoRunway);
}

TEST(OutlineFit, AskedForSomethingTooSmallItFails) {
  const RunwayPicture picture;
  EXPECT_FALSE(Fit(picture, poseAt(-30000, 1000)).found);
}

}  // namespace
}  // namespace uav_landing
