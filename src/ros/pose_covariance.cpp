#include "pose_covariance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "body_pose.h"
#include "geometry/cross_matrix.h"

namespace uav_landing {
namespace {

/// Covariance of (height, roll, pitch) due to the errors of the plane.
Eigen::Matrix3d ofPlane(const GroundPlane& plane) {
  const Eigen::Vector3d n = plane.normal();
  const double h = plane.height(), level2 = n.x() * n.x() + n.y() * n.y();
  const Eigen::Matrix3d turn = h * (Eigen::Matrix3d::Identity() - n * n.transpose());  // dn / dg
  Eigen::Matrix3d by_g;
  by_g.row(0) = -h * h * n.transpose();
  by_g.row(1) = Eigen::RowVector3d(n.y(), -n.x(), 0) / level2 * turn;
  by_g.row(2) = Eigen::RowVector3d(0, 0, -1 / std::sqrt(level2)) * turn;
  return by_g * plane.covariance * by_g.transpose();
}

/// Covariance of the camera's (height, roll, pitch). What the estimate claims beyond the plane's own variance
/// is independent. When a filter claims less, the correlation stays.
Eigen::Matrix3d ofCamera(const Eigen::Vector3d& claimed, const GroundPlane& plane) {
  Eigen::Matrix3d covariance = claimed.asDiagonal();
  if (!plane.valid() || !plane.covariance.allFinite()) return covariance;
  const Eigen::Matrix3d together = ofPlane(plane);
  const auto scale = [&](int i) { return std::sqrt(std::min(1.0, claimed[i] / together(i, i))); };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j) covariance(i, j) = together(i, j) * scale(i) * scale(j);
  return covariance;
}

/// Covariance of the camera's (x, y, height, roll, pitch, yaw).
Matrix6d ofCamera(const LandingResult& camera, const GroundPlane& plane, const Eigen::Vector2d& xy_variance) {
  const double yaw_variance = std::isfinite(camera.yaw_variance) ? camera.yaw_variance : M_PI * M_PI;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << xy_variance, Eigen::Vector3d::Zero(), yaw_variance;
  covariance.block<3, 3>(2, 2) =
      ofCamera({camera.height_variance, camera.roll_variance, camera.pitch_variance}, plane);
  return covariance;
}

}  // namespace

Matrix6d poseCovariance(const LandingResult& camera, const GroundPlane& plane, const Eigen::Vector3d& point,
                        const Eigen::Vector2d& xy_variance) {
  const double yaw = std::isfinite(camera.yaw) ? camera.yaw : 0;
  const Eigen::Matrix3d heading = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d climb = heading * Eigen::AngleAxisd(-camera.pitch, Eigen::Vector3d::UnitY());
  // Rotations about the runway's axes by roll, pitch (nose up is about -y) and yaw.
  Eigen::Matrix3d turns;
  turns << climb.col(0), -heading.col(1), Eigen::Vector3d::UnitZ();
  Matrix6d by_camera = Matrix6d::Identity();
  by_camera.bottomRightCorner<3, 3>() = turns;
  by_camera.topRightCorner<3, 3>() = -crossMatrix(runwayFromCamera(camera) * point) * turns;
  return by_camera * ofCamera(camera, plane, xy_variance) * by_camera.transpose();
}

double heightVariance(const LandingResult& camera, double camera_variance, const GroundPlane& plane,
                      const Eigen::Vector3d& point) {
  const Eigen::Vector3d by_camera(1, heightByRoll(camera, point), heightByPitch(camera, point));
  return by_camera.dot(ofCamera({camera_variance, camera.roll_variance, camera.pitch_variance}, plane) *
                       by_camera);
}

}  // namespace uav_landing
