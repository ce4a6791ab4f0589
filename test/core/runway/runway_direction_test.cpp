#include "runway/direction/runway_direction.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Pose;

struct Scene {
  StereoRig rig = test::makeRig(480, 360, 0.65);
  RigModel model = test::makeModel(rig);
  GroundRenderer ground{61};
  ApproachAngleParameters parameters;
  Pose pose;
  double plane_pitch_error = 0, plane_height_error = 0;  // rad, share
  bool has_runway = true;
  RunwayParameters runway;
  cv::Mat left, right;

  Scene() {
    ground.contrast = 2;
    ground.line_offset = 1.1;
    ground.line_width = 0.12;
    pose.position = {0, 0.2, 1.7};
    pose.pitch = -6 * kDegree;
    pose.roll = 3 * kDegree;
    pose.yaw = -4 * kDegree;
    left = ground.left(rig, pose);
    right = ground.right(rig, pose);
  }

  RunwayDirection find(bool with_normal) {
    Timings timings;
    RunwayDirectionMemory memory;
    const Eigen::Vector3d down = Eigen::AngleAxisd(plane_pitch_error, Eigen::Vector3d::UnitX()) * pose.down();
    const SeenGround ground_seen{
        {down / (pose.height() * (1 + plane_height_error)), Eigen::Matrix3d::Identity() * 1e-8},
        {},
        has_runway,
        std::nullopt,
        std::nullopt,
        runway};
    return findRunwayDirection({rig, {left, model.left_mask}, {right, model.right_mask}},
                               with_normal ? &ground_seen : nullptr, parameters, memory, timings);
  }
  /// The runway runs along x.
  double error(const Eigen::Vector3d& direction) const {
    return direction.cross(pose.seen(Eigen::Vector3d::UnitX())).norm();
  }
};

TEST(RunwayDirection, IsThatOfThePaintedLinesInBothViewsAndTogether) {
  for (const bool with_normal : {true, false}) {
    Scene scene;
    const RunwayDirection found = scene.find(with_normal);
    ASSERT_TRUE(found.combined) << found.combined.error().message();
    EXPECT_LT(scene.error(found.left.vanishing_direction), 0.2 * kDegree);
    // The right view has its own principal point; rays are those of one common frame all the same.
    EXPECT_LT(scene.error(found.right.vanishing_direction), 0.2 * kDegree);
    EXPECT_LT(scene.error(found.combined->direction), 0.15 * kDegree);
    EXPECT_NEAR(found.combined->direction.norm(), 1, 1e-9);
  }
}

// Of stripes hardly a pixel wide a blurred picture shows sides that are pushed apart: 0.1 degrees between
// vanishing points, or none at all.
TEST(RunwayDirection, IsFreeOfWhatBlurDoesToStripes) {
  for (const bool with_normal : {true, false}) {
    Scene scene;
    scene.ground.line_width = 0.04;
    scene.left = scene.ground.left(scene.rig, scene.pose);
    scene.right = scene.ground.right(scene.rig, scene.pose);
    for (const cv::Mat& image : {scene.left, scene.right}) cv::GaussianBlur(image, image, {}, 0.8);
    const RunwayDirection found = scene.find(with_normal);
    ASSERT_FALSE(found.left.failure || found.right.failure) << with_normal;
    EXPECT_LT(scene.error(found.left.vanishing_direction), 0.02 * kDegree) << with_normal;
    EXPECT_LT(scene.error(found.right.vanishing_direction), 0.02 * kDegree) << with_normal;
  }
}

/// Strips of 1 m along x, each brighter than the one to its right: no two of their edges are those of a
/// runway.
cv::Mat stairs(const Scene& scene, double offset, double cx) {
  const Eigen::Matrix3d R = scene.pose.worldFromOptical();
  const Eigen::Vector3d camera = scene.pose.position + R * Eigen::Vector3d(offset, 0, 0);
  cv::Mat image(scene.rig.size, CV_8UC1, cv::Scalar(120));
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const Eigen::Vector3d ray =
          R * Eigen::Vector3d((u - cx) / scene.rig.fx, (v - scene.rig.cy) / scene.rig.fy, 1);
      if (ray.z() >= 0) continue;
      const double y = camera.y() - camera.z() / ray.z() * ray.y();
      image.at<uchar>(v, u) = cv::saturate_cast<uchar>(40 + 30 * std::clamp(std::floor(y + 3), 0.0, 6.0));
    }
  }
  cv::GaussianBlur(image, image, {}, 0.8);
  return image;
}

TEST(RunwayDirection, OfAGrassStripIsBelievedOnlyWhereItsTwoEdgesShow) {
  for (const bool paved : {true, false}) {
    Scene scene;
    scene.runway.paved = paved;
    EXPECT_TRUE(scene.find(true).combined) << "with edges";
    scene.left = stairs(scene, 0, scene.rig.cx);
    scene.right = stairs(scene, scene.rig.baseline, scene.rig.cx_right);
    EXPECT_EQ(scene.find(true).combined.has_value(), paved) << "without";
  }
}

TEST(RunwayDirection, LooksBelowTheHorizonOnlyWhenTheGroundIsKnown) {
  Scene scene;
  // A fan of strong edges in the sky that meet 25 degrees to the left of the runway, above the horizon.
  for (cv::Mat* image : {&scene.left, &scene.right})
    for (int x = -150; x <= 420; x += 57) cv::line(*image, {60, 110}, {x, 0}, cv::Scalar(20), 2, cv::LINE_AA);
  const RunwayDirection found = scene.find(true);
  ASSERT_TRUE(found.combined) << found.combined.error().message();
  EXPECT_LT(scene.error(found.combined->direction), 0.15 * kDegree);
  for (const ApproachAngleResult::Line& line : found.left.lines) {
    const Eigen::Vector2d middle = 0.5 * (line.a + line.b);
    EXPECT_GT(scene.pose.down().dot(scene.rig.ray(middle.x(), middle.y())), 0);
  }
}

TEST(RunwayDirection, ComesFromOneViewWhenTheOtherSeesNothing) {
  for (const bool blind_left : {false, true}) {
    Scene scene;
    (blind_left ? scene.left : scene.right).setTo(cv::Scalar(100));
    const RunwayDirection found = scene.find(true);
    const ApproachAngleResult::View &blind = blind_left ? found.left : found.right,
                                    &seeing = blind_left ? found.right : found.left;
    EXPECT_FALSE(seeing.failure);
    EXPECT_TRUE(blind.failure);
    EXPECT_FALSE(blind.vanishing_direction.allFinite());
    ASSERT_TRUE(found.combined);
    EXPECT_LT(scene.error(found.combined->direction), 0.2 * kDegree);
  }
}

/// Whether the right view finds an edge that it alone sees, as it does when it looks for lines of its own.
bool findsItsOwn(Scene& scene) {
  const cv::Point from(150, 330), to(190, 260);
  cv::line(scene.right, from, to, cv::Scalar(20), 3, cv::LINE_AA);
  const RunwayDirection found = scene.find(true);
  EXPECT_FALSE(found.left.failure);
  EXPECT_FALSE(found.right.failure);
  const Eigen::Vector2d middle(0.5 * (from.x + to.x), 0.5 * (from.y + to.y));
  return std::any_of(found.right_lines.begin(), found.right_lines.end(), [&](const LineSegment& line) {
    return std::abs(line.line.dot(middle.homogeneous())) < 3 && (line.middle() - middle).norm() < 20;
  });
}

TEST(RunwayDirection, FollowsTheLinesOfTheLeftViewIntoTheRightOne) {
  Scene scene;
  EXPECT_FALSE(findsItsOwn(scene));
}

TEST(RunwayDirection, LooksForLinesOfItsOwnUntilARunwayIsKnown) {
  Scene scene;
  scene.has_runway = false;
  EXPECT_TRUE(findsItsOwn(scene));
}

TEST(RunwayDirection, IsNotFollowedFromAPointThatIsNotOnTheGround) {
  Scene scene;
  scene.plane_pitch_error = 0.6 * kDegree;
  EXPECT_TRUE(findsItsOwn(scene));
}

TEST(RunwayDirection, LooksForLinesOfItsOwnWhereThoseFollowedAreLost) {
  Scene scene;
  scene.plane_height_error = 0.2;
  EXPECT_TRUE(findsItsOwn(scene));
}

TEST(RunwayDirection, LooksInsideTheMasksOnly) {
  Scene scene;
  scene.model.left_mask = 0;
  scene.model.right_mask = 0;
  const RunwayDirection found = scene.find(true);
  EXPECT_TRUE(found.left.lines.empty() && found.right.lines.empty());
  EXPECT_FALSE(found.combined);
}

TEST(RunwayDirection, IsNoneWithoutLinesAndSaysWhy) {
  Scene scene;
  scene.left.setTo(cv::Scalar(100));
  scene.right.setTo(cv::Scalar(100));
  const RunwayDirection found = scene.find(true);
  ASSERT_FALSE(found.combined);
  EXPECT_TRUE(found.combined.error().reason == Reason::kTooFewFeatures ||
              found.combined.error().reason == Reason::kNoVanishingPoint)
      << found.combined.error().message();
  EXPECT_FALSE(found.combined.error().detail.empty());
}

}  // namespace
}  // namespace uav_landing
