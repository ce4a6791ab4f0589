#include "uav_landing/geometry/ground_plane.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "geometry/rotation.h"

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

GroundPlane fuseVanishingPoint(const GroundPlane& plane, const Eigen::Vector3d& p,
                               const Eigen::Matrix3d& p_covariance, double max_nis, double* nis) {
  const double innovation = -p.dot(plane.g);
  const double noise = plane.g.dot(p_covariance * plane.g);
  const double variance = p.dot(plane.covariance * p) + noise;
  const double ratio = innovation * innovation / variance;
  if (nis != nullptr) *nis = ratio;
  if (!(variance > 0 && ratio <= max_nis)) return plane;  // also when anything is NaN
  const Eigen::Vector3d gain = plane.covariance * p / variance;
  const Eigen::Matrix3d keep = Eigen::Matrix3d::Identity() - gain * p.transpose();
  GroundPlane fused;
  fused.g = plane.g + gain * innovation;
  fused.covariance = keep * plane.covariance * keep.transpose() + noise * gain * gain.transpose();
  return fused;
}

std::array<GroundDirection, 2> levelDirections(const GroundNormal& ground) {
  const Eigen::Vector3d& normal = ground.n;
  const Eigen::Matrix3d& covariance = ground.covariance;
  const Eigen::Vector3d forward = (Eigen::Vector3d::UnitZ() - normal.z() * normal).normalized();
  const Eigen::Vector3d left = forward.cross(normal);
  // Only the error out of the plane counts.
  const Eigen::Matrix3d along = normal * normal.transpose();
  return {GroundDirection{forward, forward.dot(covariance * forward) * along},
          GroundDirection{left, left.dot(covariance * left) * along}};
}

GroundNormal weightedMean(const GroundNormal& a, const GroundNormal& b) {
  const Eigen::Matrix<double, 3, 2> across = tangents(a.n);
  const Eigen::Matrix2d of_a = across.transpose() * a.covariance * across;
  const Eigen::Matrix2d of_b = across.transpose() * b.covariance * across;
  const Eigen::Matrix2d gain = of_a * (of_a + of_b).inverse();
  if (!gain.allFinite()) return a;
  const Eigen::Vector3d n = (a.n + across * gain * across.transpose() * (b.n - a.n)).normalized();
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity() - n * n.transpose();
  return {n, level * across * (of_a - gain * of_a) * across.transpose() * level};
}

GroundPlane fuseNormal(const GroundPlane& plane, const GroundNormal& ground, double max_nis, double* nis) {
  GroundPlane fused = plane;
  double worst = 0;
  for (const GroundDirection& level : levelDirections(ground)) {
    double ratio = 0;
    fused = fuseVanishingPoint(fused, level.direction, level.covariance, max_nis, &ratio);
    worst = ratio > worst || std::isnan(ratio) ? ratio : worst;
  }
  if (nis != nullptr) *nis = worst;
  return worst <= max_nis ? fused : plane;
}

double yawOf(const Eigen::Vector3d& normal, const Eigen::Vector3d& landing_direction) {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d& p = landing_direction;
  // Sine and cosine of the angle between the parts of both vectors that lie in the ground; up is -n.
  return std::atan2(-normal.dot(p.cross(axis)), p.dot(axis) - normal.dot(p) * normal.dot(axis));
}

}  // namespace uav_landing
