#include "uav_landing/geometry/ground_plane.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace uav_landing {

double GroundPlane::heightVariance() const {
  const Eigen::Vector3d n = normal();
  return n.dot(covariance * n) * std::pow(height(), 4);
}

Eigen::Matrix3d GroundPlane::normalCovariance() const {
  const Eigen::Vector3d n = normal();
  const Eigen::Matrix3d J = height() * (Eigen::Matrix3d::Identity() - n * n.transpose());
  return J * covariance * J.transpose();
}

double pitchOf(const Eigen::Vector3d& normal) { return -std::asin(std::clamp(normal.z(), -1.0, 1.0)); }

double rollOf(const Eigen::Vector3d& normal) { return std::atan2(normal.x(), normal.y()); }

double pitchVariance(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance) {
  return covariance(2, 2) / (1 - normal.z() * normal.z());
}

double rollVariance(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector2d J = Eigen::Vector2d(normal.y(), -normal.x()) / normal.head<2>().squaredNorm();
  return J.dot(covariance.topLeftCorner<2, 2>() * J);
}

Eigen::Vector3d normalFromPitchRoll(double pitch, double roll) {
  return {std::cos(pitch) * std::sin(roll), std::cos(pitch) * std::cos(roll), -std::sin(pitch)};
}

Eigen::Vector3d horizonLine(const StereoRig& rig, const Eigen::Vector3d& normal) {
  return rig.Kinv().transpose() * normal;
}

double yawOf(const Eigen::Vector3d& normal, const Eigen::Vector3d& landing_direction) {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d& p = landing_direction;
  // Sine and cosine of the angle between the parts of both vectors that lie in the ground; up is -n.
  return std::atan2(-normal.dot(p.cross(axis)), p.dot(axis) - normal.dot(p) * normal.dot(axis));
}

}  // namespace uav_landing
