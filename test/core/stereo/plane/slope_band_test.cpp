#include "stereo/plane/slope_band.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "image/windows/match_image.h"
#include "stereo/plane/plane_rivals.h"
#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::kDegree;

/// A right image that is the left one moved by a disparity that changes with the row.
struct Shifted {
  static constexpr int kWidth = 320, kHeight = 240;
  StereoRig rig = test::makeRig(kWidth, kHeight, 1.0);
  RigModel model = test::makeModel(rig);
  StereoDepthParameters parameters;
  PlaneLimits limits{30 * kDegree, 30 * kDegree, 20, 0.6};
  StereoLevel level;
  cv::Mat right;

  Shifted(double at_centre, double slope) {
    cv::Mat texture(kHeight, 2 * kWidth, CV_32F);
    cv::RNG(5).fill(texture, cv::RNG::UNIFORM, 0, 255);
    cv::GaussianBlur(texture, texture, cv::Size(), 1.0);
    level = reduceLevel(model, 1, parameters.window_radius + 2);
    level.left = texture.colRange(kWidth / 2, kWidth / 2 + kWidth).clone();
    cv::Mat columns(kHeight, kWidth, CV_32F), rows(kHeight, kWidth, CV_32F);
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        columns.at<float>(v, u) =
            static_cast<float>(u + kWidth / 2 + disparity(at_centre, slope, v) + rig.principalOffset());
        rows.at<float>(v, u) = static_cast<float>(v);
      }
    cv::remap(texture, level.right, columns, rows, cv::INTER_LINEAR);
    addRoomBeside(level.right, right);
  }
  double disparity(double at_centre, double slope, double v) const {
    return at_centre + slope * (v - rig.cy);
  }

  BandCandidates look(const SlopeBand& band, const std::vector<cv::Point>& corners) const {
    return candidatesOf(band, {level, right}, corners, parameters, limits);
  }
};

std::vector<cv::Point> grid() {
  std::vector<cv::Point> corners;
  for (int v = 30; v < 210; v += 20)
    for (int u = 20; u < 300; u += 20) corners.emplace_back(u, v);
  return corners;
}

bool has(const DisparitySample& sample, double disparity) {
  const auto near = [&](double value) { return std::abs(value - disparity) < 0.5; };
  return near(sample.disparity) || std::any_of(sample.others.begin(), sample.others.end(), near);
}

TEST(SlopeBand, FindsTheDisparityOfCornersThatTheRightImageShows) {
  const SlopeBand band = SlopeBands::at(4);
  const double at_centre = 30, slope = band.shear;
  const Shifted images(at_centre, slope);
  const BandCandidates found = images.look(band, grid());
  int shown = 0, right = 0;
  for (const cv::Point& corner : grid())
    shown += corner.x - images.disparity(at_centre, slope, corner.y) > images.parameters.window_radius + 2;
  for (const DisparitySample& sample : found.samples)
    right += has(sample, images.disparity(at_centre, slope, sample.v));
  EXPECT_GT(right, 0.9 * shown);
  EXPECT_GT(found.scored, shown);
}

TEST(SlopeBand, WindowsAreShearedForItsSlope) {
  const double at_centre = 60, slope = SlopeBands::at(7).shear;
  const Shifted images(at_centre, slope);
  const auto right = [&](size_t index) {
    const BandCandidates found = images.look(SlopeBands::at(index), grid());
    return std::count_if(found.samples.begin(), found.samples.end(), [&](const DisparitySample& sample) {
      return has(sample, images.disparity(at_centre, slope, sample.v));
    });
  };
  EXPECT_GT(right(7), 4 * right(3));
}

// What is farther away than any plane of the band says nothing; nor does the slope of its peak at the end.
TEST(SlopeBand, LooksNoFartherThanPlanesWithinTheLimitsReach) {
  const Shifted images(100, 0);
  const SlopeBand far = SlopeBands::at(0);
  for (const DisparitySample& sample : images.look(far, grid()).samples) {
    EXPECT_FALSE(has(sample, 100));
    EXPECT_LT(sample.disparity, 40);
  }
}

TEST(SlopeBand, NextToEachOtherTheyOverlap) {
  for (size_t i = 0; i + 1 < SlopeBands::kAll; ++i) {
    const SlopeBand band = SlopeBands::at(i), next = SlopeBands::at(i + 1);
    EXPECT_LE(band.range.x(), band.shear);
    EXPECT_GE(band.range.y(), next.shear);
    EXPECT_LE(next.range.x(), band.shear);
  }
}

TEST(SlopeBand, TheLargestWindowHasRoomBesideTheImage) {
  Shifted images(20, SlopeBands::at(9).shear);
  images.parameters.window_radius = kLargestWindowRadius;
  std::vector<cv::Point> corners;
  for (int v = 20; v < 220; v += 10)
    for (const int u : {15, 16, 303, 304}) corners.emplace_back(u, v);
  for (size_t i = 0; i < SlopeBands::kAll; ++i)
    for (const DisparitySample& sample : images.look(SlopeBands::at(i), corners).samples)
      EXPECT_TRUE(std::isfinite(sample.disparity));
}

TEST(RivalPlane, TheRightOneMatchesBetterThanOneThatIsOff) {
  test::GroundRenderer ground{17};
  ground.grain = 0.02;
  const StereoRig rig = test::makeRig(320, 240, 0.65);
  const RigModel model = test::makeModel(rig);
  const test::Pose pose = test::makePose(2, -8, 0);
  const StereoDepthParameters parameters;
  StereoLevel level = reduceLevel(model, 1, parameters.window_radius + 2);
  MatchImage left, right;
  left.assign(ground.left(rig, pose));
  right.assign(ground.right(rig, pose));
  level.left = left.coarse;
  level.right = right.coarse;
  std::vector<cv::Point> corners;
  for (const cv::Point& corner : grid())
    if (corner.y > 100) corners.push_back(corner);
  const Eigen::Vector3d g = pose.down() / pose.height();
  const RivalPlane true_plane(level, corners, PlaneVector(g), parameters);
  const RivalPlane off(level, corners, PlaneVector(1.02 * g), parameters);
  constexpr int kLeast = 10;
  EXPECT_TRUE(true_plane.matchesBetterThan(off, kLeast));
  EXPECT_FALSE(off.matchesBetterThan(true_plane, kLeast));
  EXPECT_FALSE(true_plane.matchesBetterThan(off, static_cast<int>(corners.size()) + 1)) << "too few corners";
}

}  // namespace
}  // namespace uav_landing
