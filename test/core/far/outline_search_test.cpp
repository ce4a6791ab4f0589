#include "far/outline_search.h"

#include <gtest/gtest.h>

#include "runway_picture.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

void expectFound(const RunwayPicture& picture, const RunwayPose& pose, double tolerance) {
  const cv::Mat image = picture.render(pose);
  const cv::Mat mask(image.size(), CV_8U, cv::Scalar(255));
  const auto found = searchOutlines(image, mask, {100, 120, 440, 240});
  const Corners corners = *cornersOf(pose, {picture.width, picture.length}, picture.rig());
  ASSERT_FALSE(found.empty());
  for (int i = 0; i < kSides; ++i)
    EXPECT_LT((found.front().corners[i] - corners[i]).norm(), tolerance)
        << "corner " << i << ": " << found.front().corners[i].transpose() << " instead of "
        << corners[i].transpose();
}

TEST(OutlineSearch, FindsARunwayFromAfar) {
  for (const double x : {-3600.0, -2000.0, -1000.0})
    expectFound(RunwayPicture(), {{x, 0, -x * 0.055}, 3 * kDegree, -3 * kDegree, 1 * kDegree}, 3);
}

TEST(OutlineSearch, FindsOneThatIsBrighterThanTheGround) {
  RunwayPicture picture;
  picture.surface = 140;
  expectFound(picture, {{-2000, 30, 110}, 0, -2 * kDegree, -3 * kDegree}, 3);
}

TEST(OutlineSearch, DoesNotEndAtAMarkAcross) {
  // At 1 km the runway is 25 px wide. The mark covers one row and blurs into the next, close to the near end.
  RunwayPicture picture;
  picture.stripe = picture.bars = 0;
  picture.across_from = 60;
  picture.across_to = 90;
  expectFound(picture, {{-1000, 0, 55}, 3 * kDegree, -3 * kDegree, 1 * kDegree}, 3);
}

TEST(OutlineSearch, DoesNotEndAtAWideMarkOnAWideRunway) {
  // At 400 m the runway is 62 px wide. The mark covers two rows, four rows before the near end.
  RunwayPicture picture;
  picture.stripe = picture.bars = 0;
  picture.across_from = 33;
  picture.across_to = 50;
  expectFound(picture, {{-400, 0, 40}, 3 * kDegree, -3 * kDegree, 0}, 3);
}

TEST(OutlineSearch, FindsNothingOnBareGround) {
  RunwayPicture picture;
  picture.surface = picture.paint = picture.ground;
  const cv::Mat image = picture.render({{-2000, 0, 110}, 0, -3 * kDegree, 0});
  EXPECT_TRUE(
      searchOutlines(image, cv::Mat(image.size(), CV_8U, cv::Scalar(255)), {100, 120, 440, 240}).empty());
}

TEST(OutlineSearch, LeavesOutWhatTheMaskDoes) {
  const RunwayPose pose{{-2000, 0, 110}, 0, -3 * kDegree, 0};
  const cv::Mat image = RunwayPicture().render(pose);
  EXPECT_TRUE(
      searchOutlines(image, cv::Mat(image.size(), CV_8U, cv::Scalar(0)), {100, 120, 440, 240}).empty());
  EXPECT_TRUE(searchOutlines(image, cv::Mat(image.size(), CV_8U, cv::Scalar(255)), {900, 0, 10, 10}).empty());
}

}  // namespace
}  // namespace uav_landing
