#include "height/reconstruction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/rigs.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

StereoRig makeRig() { return test::rigOf({640, 480}, 500, {322, 243}, 330, 0.65); }

/// The pixel and disparity of a point in the left camera's frame, by projecting it into both cameras.
StereoDepthResult::Point see(const StereoRig& rig, const Eigen::Vector3d& X) {
  StereoDepthResult::Point point;
  point.u = rig.fx * X.x() / X.z() + rig.cx;
  point.v = rig.fy * X.y() / X.z() + rig.cy;
  const double u_right = rig.fx * (X.x() - rig.baseline) / X.z() + rig.cx_right;
  point.disparity = (point.u - u_right) - (rig.cx - rig.cx_right);
  point.on_plane = true;
  return point;
}

/// Ground points below a camera at height h that looks down by alpha with its right side down by roll.
/// Built in a level frame (right, forward, down) and turned into the camera, so that nothing of the code
/// under test is used.
std::vector<StereoDepthResult::Point> seeGround(const StereoRig& rig, double h, double alpha, double roll) {
  std::vector<StereoDepthResult::Point> points;
  for (double forward : {6.0, 8.0, 11.0, 15.0}) {
    for (double right : {-2.0, -0.5, 1.0, 2.5}) {
      // Nose down by alpha: forward and down mix.
      const double depth = forward * std::cos(alpha) + h * std::sin(alpha);
      const double below_axis = h * std::cos(alpha) - forward * std::sin(alpha);
      // Right side down by roll: what is below appears to the right of the image's vertical.
      points.push_back(see(rig, {right * std::cos(roll) + below_axis * std::sin(roll),
                                 below_axis * std::cos(roll) - right * std::sin(roll), depth}));
    }
  }
  return points;
}

TEST(Reconstruction, DepthFollowsEquation3) {
  // f b = 325 px m: 13 px are 25 m.
  EXPECT_DOUBLE_EQ(depthFromDisparity(makeRig(), 13.0), 25.0);
}

TEST(Reconstruction, Equation4LevelsTheCamera) {
  // On the optical axis, 10 m ahead, camera 30 degrees down: 5 m below, 8.66 m ahead.
  const Eigen::Vector3d level = rotateToWorld({1, 10, 0}, 30 * kDegree);
  EXPECT_NEAR(level.x(), 1, 1e-12);
  EXPECT_NEAR(level.y(), 10 * std::sqrt(3) / 2, 1e-12);
  EXPECT_NEAR(level.z(), 5, 1e-12);
}

TEST(Reconstruction, Equation5IsTheThirdRowOfEquation4) {
  EXPECT_NEAR(heightOverPoint(7.3, -0.4, 0.21), rotateToWorld({3, 7.3, -0.4}, 0.21).z(), 1e-12);
}

TEST(Reconstruction, AveragedHeightIsThatOfThePlane) {
  const StereoRig rig = makeRig();
  const double h = 2.3, alpha = 14 * kDegree;
  for (double roll : {0.0, 9 * kDegree, -20 * kDegree}) {
    const auto points = seeGround(rig, h, alpha, roll);
    const AveragedHeight averaged = averageHeight(rig, points, alpha, roll, true);
    EXPECT_NEAR(averaged.height, h, 1e-9) << "roll " << roll;
    EXPECT_NEAR(averaged.variance, 0, 1e-15);
    EXPECT_EQ(averaged.points, 16);
    // The plane with this attitude predicts the very disparities.
    GroundPlane plane;
    plane.g = normalFromPitchRoll(-alpha, roll) / h;
    for (const auto& point : points)
      EXPECT_NEAR(plane.disparity(rig, point.u, point.v), point.disparity, 1e-9);
  }
}

TEST(Reconstruction, ApproachAngleInPlaceOfPitchTurnsEveryRayByTheirDifference) {
  // The paper to the letter: a ground point at range s that lies beta below the axis is at s sin(alpha +
  // beta) below, and is taken to be at s sin(theta + beta).
  const StereoRig rig = makeRig();
  const double h = 2.3, alpha = 14 * kDegree, theta = 12 * kDegree, beta = 5 * kDegree;
  const double range = h / std::sin(alpha + beta);
  const auto point = see(rig, {0, range * std::sin(beta), range * std::cos(beta)});
  const AveragedHeight averaged = averageHeight(rig, {point}, theta, 0, true);
  EXPECT_NEAR(averaged.height, range * std::sin(theta + beta), 1e-9);
  EXPECT_LT(averaged.height, h - 0.2);
}

TEST(Reconstruction, VarianceIsThatOfTheMean) {
  const StereoRig rig = makeRig();
  // Level camera: heights are Y. 1, 2 and 3 m have a variance of 1, the mean of three a third.
  const std::vector<StereoDepthResult::Point> points = {see(rig, {0, 1, 10}), see(rig, {0, 2, 10}),
                                                        see(rig, {0, 3, 10})};
  const AveragedHeight averaged = averageHeight(rig, points, 0, 0, true);
  EXPECT_NEAR(averaged.height, 2, 1e-9);
  EXPECT_NEAR(averaged.variance, 1.0 / 3, 1e-9);
}

TEST(Reconstruction, LeavesOutPointsOffThePlaneOnRequestAndThoseWithoutDepth) {
  const StereoRig rig = makeRig();
  std::vector<StereoDepthResult::Point> points = {see(rig, {0, 2, 10}), see(rig, {0, 2, 12}),
                                                  see(rig, {0, 1, 10}), see(rig, {0, 2, 12})};
  points[2].on_plane = false;
  points[3].disparity = -1;
  EXPECT_EQ(averageHeight(rig, points, 0, 0, true).points, 2);
  EXPECT_NEAR(averageHeight(rig, points, 0, 0, true).height, 2, 1e-9);
  EXPECT_EQ(averageHeight(rig, points, 0, 0, false).points, 3);
  EXPECT_NEAR(averageHeight(rig, points, 0, 0, false).height, 5.0 / 3, 1e-9);
}

TEST(Reconstruction, HasNoHeightWithoutPoints) {
  const AveragedHeight averaged = averageHeight(makeRig(), {}, 0.1, 0, true);
  EXPECT_EQ(averaged.points, 0);
  EXPECT_TRUE(std::isnan(averaged.height));
  EXPECT_TRUE(std::isnan(averaged.variance));
}

}  // namespace
}  // namespace uav_landing
