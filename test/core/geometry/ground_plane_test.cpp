#include "uav_landing/geometry/ground_plane.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>

#include "some_plane.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// Attitude as the conventions define it: runway <- body (forward, left, up), pitch and yaw up and left.
Eigen::Matrix3d runwayFromBody(double yaw, double pitch, double roll) {
  return (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// A runway direction (x along the landing, y left, z up) in the camera's optical frame (right, down,
/// forward).
Eigen::Vector3d seen(const Eigen::Matrix3d& runway_from_body, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d body = runway_from_body.transpose() * direction;
  return {-body.y(), -body.z(), body.x()};
}

StereoRig makeRig() { return test::rigOf({640, 480}, 500, {322, 243}, 330, 0.65); }

TEST(Attitude, FollowsTheSignConventions) {
  for (const double yaw : {-20.0, 0.0, 15.0})
    for (const double pitch : {-12.0, 0.0, 7.0})
      for (const double roll : {-25.0, 0.0, 10.0}) {
        const Eigen::Matrix3d R = runwayFromBody(yaw * kDegree, pitch * kDegree, roll * kDegree);
        const Eigen::Vector3d down = seen(R, -Eigen::Vector3d::UnitZ());
        EXPECT_NEAR(pitchOf(down), pitch * kDegree, 1e-12);
        EXPECT_NEAR(rollOf(down), roll * kDegree, 1e-12);
        EXPECT_NEAR(yawOf(down, seen(R, Eigen::Vector3d::UnitX())), yaw * kDegree, 1e-12);
        EXPECT_TRUE(normalFromPitchRoll(pitch * kDegree, roll * kDegree).isApprox(down, 1e-12));
      }
}

TEST(Attitude, YawDoesNotDependOnTheSlopeOfTheDirectionGiven) {
  const Eigen::Matrix3d R = runwayFromBody(0.2, -0.1, 0.15);
  const Eigen::Vector3d down = seen(R, -Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(yawOf(down, seen(R, Eigen::Vector3d(1, 0, 0.05).normalized())), 0.2, 1e-12);
}

TEST(GroundPlane, PredictsTheDisparityOfAPointOnIt) {
  const StereoRig rig = makeRig();
  const GroundPlane plane = somePlane();
  const Eigen::Vector3d n = plane.normal();
  EXPECT_NEAR(plane.height(), 12, 1e-12);
  // A point of the plane, n.X = 12, projected into both cameras.
  const Eigen::Vector3d along = n.cross(Eigen::Vector3d::UnitX()).normalized();
  const Eigen::Vector3d X = 12 * n - 60 * along + 7 * n.cross(along);
  ASSERT_GT(X.z(), 0);
  const Eigen::Vector2d left = rig.project(X);
  const double u_right = rig.fx * (X.x() - rig.baseline) / X.z() + rig.cx_right;
  EXPECT_NEAR(plane.disparity(rig, left.x(), left.y()), (left.x() - u_right) - (rig.cx - rig.cx_right), 1e-9);
  EXPECT_NEAR(plane.inverseDepth(rig.ray(left.x(), left.y())), 1 / X.z(), 1e-12);
}

TEST(GroundPlane, HasDisparityZeroOnTheHorizon) {
  const StereoRig rig = makeRig();
  const GroundPlane plane = somePlane();
  const Eigen::Vector3d l = horizonLine(rig, plane.normal());
  for (const double u : {0.0, 300.0, 639.0}) {
    const double v = -(l.x() * u + l.z()) / l.y();
    EXPECT_NEAR(plane.disparity(rig, u, v), 0, 1e-10);
  }
}

TEST(GroundPlane, VariancesAreThoseOfSamples) {
  const GroundPlane plane = somePlane();
  const Eigen::Matrix3d L = plane.covariance.llt().matrixL();
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  constexpr int kSamples = 20000;
  double height = 0, pitch = 0, roll = 0;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d n = plane.normal();
  for (int i = 0; i < kSamples; ++i) {
    GroundPlane sample;
    sample.g = plane.g + L * Eigen::Vector3d(normal(random), normal(random), normal(random));
    height += std::pow(sample.height() - 12, 2) / kSamples;
    pitch += std::pow(pitchOf(sample.normal()) - pitchOf(n), 2) / kSamples;
    roll += std::pow(rollOf(sample.normal()) - rollOf(n), 2) / kSamples;
    spread += (sample.normal() - n) * (sample.normal() - n).transpose() / kSamples;
  }
  const Eigen::Matrix3d covariance = plane.normalCovariance();
  EXPECT_NEAR(plane.heightVariance() / height, 1, 0.05);
  EXPECT_NEAR(pitchVariance(n, covariance) / pitch, 1, 0.05);
  EXPECT_NEAR(rollVariance(n, covariance) / roll, 1, 0.05);
  EXPECT_LT((covariance - spread).norm() / spread.norm(), 0.05);
  EXPECT_NEAR((covariance * n).norm(), 0, 1e-12);
}

TEST(GroundPlane, IsNotValidBeforeItIsKnown) { EXPECT_FALSE(GroundPlane().valid()); }

}  // namespace
}  // namespace uav_landing
