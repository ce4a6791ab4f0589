#include "far/outline_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kFocal = 554, kColumn = 320, kRow = 240;

StereoRig rig() {
  StereoRig result;
  result.size = {640, 480};
  result.fx = result.fy = kFocal;
  result.cx = result.cx_right = kColumn;
  result.cy = kRow;
  result.baseline = 1;
  return result;
}

/// A camera by hand: x, y of the runway frame, height, and angles of LandingResult.
struct Camera {
  double x, y, height, roll = 0, pitch = 0, yaw = 0;

  /// Steps from the camera to the point, turned by yaw, then pitch, then roll.
  Eigen::Vector2d pixelOf(double along, double left) const {
    const double dx = along - x, dy = left - y;
    const double ahead = std::cos(yaw) * dx + std::sin(yaw) * dy;
    const double aside = -std::sin(yaw) * dx + std::cos(yaw) * dy;  // left
    const double depth = std::cos(pitch) * ahead - std::sin(pitch) * height;
    const double down = std::sin(pitch) * ahead + std::cos(pitch) * height;
    const double right_tilted = std::cos(roll) * -aside + std::sin(roll) * down;
    const double down_tilted = -std::sin(roll) * -aside + std::cos(roll) * down;
    return {kColumn + kFocal * right_tilted / depth, kRow + kFocal * down_tilted / depth};
  }
  Corners cornersOf(double width, double length) const {
    return {pixelOf(0, width / 2), pixelOf(length, width / 2), pixelOf(length, -width / 2),
            pixelOf(0, -width / 2)};
  }
};

/// Seen with errors of this many pixels at every end of every side.
SeenOutline seenBy(const Camera& camera, double width, double length, double stddev = 0.1) {
  return {camera.cornersOf(width, length), Vector8d::Zero(), stddev * stddev * Matrix8d::Identity()};
}

GroundNormal normalOf(const Camera& camera, double stddev) {
  const double roll = camera.roll, pitch = camera.pitch;
  const Eigen::Vector3d n(std::sin(roll) * std::cos(pitch), std::cos(roll) * std::cos(pitch),
                          -std::sin(pitch));
  return {n, stddev * stddev * (Eigen::Matrix3d::Identity() - n * n.transpose())};
}

TEST(OutlinePose, OfAnExactOutlineIsWhereTheCameraIs) {
  for (const Camera& camera : {Camera{-3600, 0, 200, 0, -3 * kDegree, 0},
                               Camera{-3000, 40, 150, 3 * kDegree, -2 * kDegree, 2 * kDegree},
                               Camera{-1000, -30, 55, -5 * kDegree, -4 * kDegree, -6 * kDegree}}) {
    PoseKnowledge known;
    known.chart = {45, 2500};
    known.normal = normalOf(camera, 0.3 * kDegree);
    const auto found = fitPose(seenBy(camera, 45, 2500), known, rig());
    ASSERT_TRUE(found) << found.error().message();
    // Roll and pitch are expected to be 0 within 10 degrees, which pulls by a hundredth of them.
    EXPECT_NEAR(found->pose.position.x() / camera.x, 1, 2e-3);
    EXPECT_NEAR(found->pose.position.y(), camera.y, 1);
    EXPECT_NEAR(found->pose.position.z() / camera.height, 1, 3e-3);
    EXPECT_NEAR(found->pose.roll, camera.roll, 0.02 * kDegree);
    EXPECT_NEAR(found->pose.pitch, camera.pitch, 0.02 * kDegree);
    EXPECT_NEAR(found->pose.yaw, camera.yaw, 0.03 * kDegree);
    EXPECT_LT(found->misfit, 1);
  }
}

TEST(OutlinePose, WidthAndLengthGiveTheHeightWithoutAHorizon) {
  const Camera camera{-3600, 10, 200, 1 * kDegree, -3 * kDegree, 0.5 * kDegree};
  PoseKnowledge known;
  known.chart = {45, 2500};
  const auto found = fitPose(seenBy(camera, 45, 2500, 0.05), known, rig());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->pose.position.z() / camera.height, 1, 0.01);
  // h = v D (D + L) / (f L): D to 0.05 px of 6.9 px, at both edges.
  const double of_distance = 0.05 / (kFocal * 45 / 3600);
  const double stddev = std::sqrt(found->covariance(2, 2)) / camera.height;
  EXPECT_GT(stddev, 0.5 * of_distance);
  EXPECT_LT(stddev, 6 * of_distance);
}

TEST(OutlinePose, ErrorsAreAsLargeAsClaimed) {
  const Camera camera{-2000, 20, 105, 2 * kDegree, -3 * kDegree, 1 * kDegree};
  const double stddev = 0.1, of_normal = 0.1 * kDegree;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  constexpr int kSamples = 400;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    SeenOutline seen = seenBy(camera, 45 + 0.3 * normal(random), 2500 + 5 * normal(random), stddev);
    for (int k = 0; k < 8; ++k) seen.inward[k] = stddev * normal(random);
    Camera tilted = camera;
    tilted.roll += of_normal * normal(random);
    tilted.pitch += of_normal * normal(random);
    PoseKnowledge known;
    known.chart = {45, 2500};
    known.normal = normalOf(tilted, of_normal);
    const auto found = fitPose(seen, known, rig());
    ASSERT_TRUE(found);
    const Eigen::Vector3d error = found->pose.position - Eigen::Vector3d(camera.x, camera.y, camera.height);
    squares += error.cwiseAbs2().cwiseQuotient(found->covariance.diagonal().head<3>()) / kSamples;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(squares[i]), 1, 0.12) << "axis " << i;
}

/// Of the point in the middle of the runway, by its depth.
SurfaceDisparity disparityOf(const Camera& camera, double along, double stddev) {
  const double dx = along - camera.x, dy = -camera.y;
  const double ahead = std::cos(camera.yaw) * dx + std::sin(camera.yaw) * dy;
  const double depth = std::cos(camera.pitch) * ahead - std::sin(camera.pitch) * camera.height;
  return {camera.pixelOf(along, 0), kFocal / depth, stddev * stddev};
}

TEST(OutlinePose, TheDisparityOfTheRunwayGivesTheScaleWithoutAChart) {
  const Camera camera{-600, 5, 40, 1 * kDegree, -3 * kDegree, 0.5 * kDegree};
  PoseKnowledge known;
  known.normal = normalOf(camera, 0.02 * kDegree);
  known.disparity = disparityOf(camera, 300, 0.01);
  const auto found = fitPose(seenBy(camera, 30, 1500), known, rig());
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->pose.position.x(), camera.x, 10);
  EXPECT_NEAR(found->pose.position.z(), camera.height, 0.5);
  EXPECT_NEAR(found->size.width, 30, 0.5);
  // A hundredth of a pixel of 554 px m / 900 m.
  const double of_scale = 0.01 / known.disparity->value;
  EXPECT_GT(std::sqrt(found->covariance(6, 6)), 0.8 * of_scale);
  EXPECT_LT(std::sqrt(found->covariance(6, 6)), 2 * of_scale);
}

TEST(OutlinePose, StereoOutweighsAChartThatIsWrong) {
  const Camera camera{-600, 0, 40, 0, -3 * kDegree, 0};
  PoseKnowledge known;
  known.chart = {45, 2500};
  known.normal = normalOf(camera, 0.3 * kDegree);
  const SeenOutline seen = seenBy(camera, 38, 2100);
  const auto by_chart = fitPose(seen, known, rig());
  ASSERT_TRUE(by_chart);
  EXPECT_GT(std::abs(by_chart->pose.position.x() / camera.x - 1), 0.12);
  known.disparity = disparityOf(camera, 300, 0.01);
  const auto found = fitPose(seen, known, rig());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->pose.position.x() / camera.x, 1, 0.06);
  EXPECT_LT(std::abs(found->pose.position.x() - camera.x), 2.5 * std::sqrt(found->covariance(0, 0)));
  EXPECT_LT(std::abs(found->pose.position.z() - camera.height), 2.5 * std::sqrt(found->covariance(2, 2)));
}

TEST(OutlinePose, SaysByHowMuchTheHeightFollowsWhatIsKnown) {
  const Camera camera{-900, 0, 55, 0, -3 * kDegree, 0};
  PoseKnowledge known;
  known.chart = {45, 2500};
  known.normal = normalOf(camera, 0.1 * kDegree);
  known.disparity = disparityOf(camera, 400, 0.02);
  const SeenOutline seen = seenBy(camera, 45, 2500);
  const auto found = fitPose(seen, known, rig());
  ASSERT_TRUE(found);
  const auto growth = [&](const PoseKnowledge& other, double by) {
    return (fitPose(seen, other, rig())->pose.position.z() - found->pose.position.z()) / by;
  };
  PoseKnowledge wider = known, longer = known, nearer = known;
  wider.chart.width *= 1.001;
  longer.chart.length *= 1.001;
  nearer.disparity = disparityOf(camera, 400, 0.02);
  nearer.disparity->value += 0.001;
  EXPECT_NEAR(found->height_by_width, growth(wider, 0.001), 0.05 * camera.height);
  EXPECT_NEAR(found->height_by_length, growth(longer, 0.001), 0.05 * camera.height);
  EXPECT_NEAR(found->height_by_disparity, growth(nearer, 0.001), 0.1 * std::abs(found->height_by_disparity));
  EXPECT_LT(found->height_by_disparity, -1);
  EXPECT_GT(found->height_by_width + found->height_by_length, 0.1 * camera.height);
}

TEST(OutlinePose, WithoutAChartThePlaneOfStereoGivesTheScale) {
  const Camera camera{-800, 5, 50, 0, -3 * kDegree, 0};
  PoseKnowledge known;
  known.plane.g = normalOf(camera, 0).vector() / camera.height;
  known.plane.covariance = std::pow(1e-3 / camera.height, 2) * Eigen::Matrix3d::Identity();
  known.normal = normalOf(camera, 0.2 * kDegree);
  const auto found = fitPose(seenBy(camera, 30, 1500, 0.05), known, rig());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->pose.position.x(), camera.x, 20);
  EXPECT_NEAR(found->pose.position.y(), camera.y, 0.3);
  EXPECT_NEAR(found->size.width, 30, 0.5);
  EXPECT_NEAR(found->size.length, 1500, 60);
  EXPECT_FALSE(fitPose(seenBy(camera, 30, 1500), PoseKnowledge(), rig())) << "nothing tells the scale";
}

TEST(OutlinePose, HowFarTheThresholdLiesOffThePlaneIsToldInOnePerCentOfTheDistance) {
  const Camera camera{-800, 5, 50, 0, -3 * kDegree, 0};
  PoseKnowledge known;
  known.chart = {45, 2500};
  known.width_stddev = 0.001;
  known.length_stddev = 0.01;
  known.normal = normalOf(camera, 0.001 * kDegree);
  const auto found = fitPose(seenBy(camera, 45, 2500, 0.001), known, rig());
  ASSERT_TRUE(found);
  for (const double below : {0.0, 16.0, -12.0}) {
    GroundPlane plane;
    plane.g = normalOf(camera, 0).vector() / (camera.height + below);
    plane.covariance = std::pow(1e-7, 2) * Eigen::Matrix3d::Identity();
    EXPECT_NEAR(offPlane(*found, plane), below / 8, 0.05) << below;
    plane.covariance = std::pow(6.0 / 800 / (camera.height + below), 2) * Eigen::Matrix3d::Identity();
    EXPECT_NEAR(offPlane(*found, plane), below / std::hypot(8, 6), 0.05) << "stereo's own doubt of 6 m there";
  }
}

TEST(OutlinePose, AnElementThatIsWrongShowsWhereItIsLeftOut) {
  const Camera camera{-1000, 0, 55, 0, -3 * kDegree, 0};
  PoseKnowledge known;
  known.chart = {49.5, 2500};  // a tenth too wide
  known.normal = normalOf(camera, 0.1 * kDegree);
  const SeenOutline seen = seenBy(camera, 45, 2500, 0.05);
  PoseElements without_width;
  without_width.width = false;
  const auto all = fitPose(seen, known, rig()), without = fitPose(seen, known, rig(), without_width);
  ASSERT_TRUE(all && without);
  EXPECT_GT(all->pose.position.z(), 57.5);
  EXPECT_NEAR(without->pose.position.z(), 55, 1);
  EXPECT_GT(all->misfit, 26) << "length and horizon contradict it";
}

TEST(OutlinePose, AnOutlineThatWidensUpwardsIsNone) {
  SeenOutline seen = seenBy({-1000, 0, 55, 0, 0, 0}, 45, 2500);
  std::swap(seen.reference[0], seen.reference[1]);
  std::swap(seen.reference[2], seen.reference[3]);
  PoseKnowledge known;
  known.chart = {45, 2500};
  EXPECT_FALSE(fitPose(seen, known, rig()));
}

}  // namespace
}  // namespace uav_landing
