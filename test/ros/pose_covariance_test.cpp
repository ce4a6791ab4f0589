#include "pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "body_pose.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
const Eigen::Vector3d kPoint(0.5, 2, -6);  // right, below, behind the camera

LandingResult camera(const GroundPlane& plane) {
  LandingResult camera;
  const Eigen::Vector3d n = plane.normal();
  camera.height = plane.height();
  camera.height_variance = plane.heightVariance();
  camera.pitch = pitchOf(n);
  camera.pitch_variance = pitchVariance(n, plane.normalCovariance());
  camera.roll = rollOf(n);
  camera.roll_variance = rollVariance(n, plane.normalCovariance());
  camera.yaw = 8 * kDegree;
  camera.yaw_variance = std::pow(0.3 * kDegree, 2);
  camera.x = -40;
  camera.y = 3;
  return camera;
}

/// Errors of height, pitch and roll that hang together, as those of points in front of the camera do.
GroundPlane plane() {
  GroundPlane plane;
  plane.g = normalFromPitchRoll(-6 * kDegree, 5 * kDegree) / 12;
  Eigen::Matrix3d root;
  root << 3, 0, 0, 0.5, 1, 0, -1, -4, 2;
  plane.covariance = root * root.transpose() * 1e-9;
  return plane;
}

Eigen::Vector3d childOf(const LandingResult& camera) {
  return Eigen::Vector3d(camera.x, camera.y, camera.height) + runwayFromCamera(camera) * kPoint;
}

TEST(PoseCovariance, IsThatOfSampledErrors) {
  const GroundPlane mean = plane();
  const LandingResult truth = camera(mean);
  const Eigen::Vector2d xy_variance(0.09, 0.01);
  const Matrix6d claimed = poseCovariance(truth, mean, kPoint, xy_variance);

  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Eigen::Matrix3d root = mean.covariance.llt().matrixL();
  Matrix6d sampled = Matrix6d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    GroundPlane erring = mean;
    erring.g += root * Eigen::Vector3d(normal(random), normal(random), normal(random));
    LandingResult estimate = camera(erring);
    estimate.x += 0.3 * normal(random);
    estimate.y += 0.1 * normal(random);
    estimate.yaw += 0.3 * kDegree * normal(random);
    Vector6d error;
    error.head<3>() = childOf(estimate) - childOf(truth);
    const Eigen::AngleAxisd turn(runwayFromCamera(estimate) * runwayFromCamera(truth).transpose());
    error.tail<3>() = turn.angle() * turn.axis();
    sampled += error * error.transpose() / kSamples;
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(claimed(i, j), sampled(i, j), 0.04 * std::sqrt(claimed(i, i) * claimed(j, j)))
          << "row " << i << ", column " << j;
}

TEST(PoseCovariance, ThePointSwingsWithTheYaw) {
  LandingResult level = camera(plane());
  level.pitch = level.roll = level.yaw = 0;
  level.yaw_variance = 1e-4;
  // A point 6 m behind moves to the right when the nose turns left.
  const Matrix6d covariance = poseCovariance(level, GroundPlane(), {0, 0, -6}, {0, 0});
  EXPECT_NEAR(covariance(1, 5), -6e-4, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 36e-4, 1e-12);
}

TEST(PoseCovariance, WhatIsNotKnownIsUnmistakable) {
  LandingResult estimate = camera(plane());
  estimate.yaw = estimate.yaw_variance = kUnknown;
  const Matrix6d covariance = poseCovariance(estimate, plane(), Eigen::Vector3d::Zero(), {1e6, 1e6});
  EXPECT_TRUE(covariance.allFinite());
  EXPECT_GE(covariance(0, 0), 1e6);
  EXPECT_GE(covariance(1, 1), 1e6);
  EXPECT_GE(covariance(5, 5), M_PI * M_PI);
}

TEST(PoseCovariance, HasNoNegativeVarianceInAnyDirection) {
  LandingResult sure = camera(plane());
  sure.height_variance *= 0.01;  // a filter's
  sure.pitch_variance *= 3;
  const Matrix6d covariance = poseCovariance(sure, plane(), kPoint, {0.01, 0.01});
  EXPECT_EQ(covariance.ldlt().info(), Eigen::Success);
  EXPECT_TRUE(covariance.ldlt().isPositive());
}

}  // namespace
}  // namespace uav_landing
