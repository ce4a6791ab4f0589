#include "geometry/ground_normal.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "geometry/rotation.h"

namespace uav_landing {

bool isUnitEstimate(const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance) {
  return std::abs(vector.norm() - 1) < kUnitRounding && covariance.allFinite();
}

void requireUnitEstimate(const char* meant, const Eigen::Vector3d& vector,
                         const Eigen::Matrix3d& covariance) {
  if (isUnitEstimate(vector, covariance)) return;
  std::ostringstream text;
  text << meant << " (" << vector.transpose() << ") has to have the length 1 and a finite covariance";
  throw std::invalid_argument(text.str());
}

std::optional<GroundNormal> normalOf(const GroundPlane& plane) {
  if (!plane.valid()) return std::nullopt;
  return GroundNormal::of(plane.normal(), plane.normalCovariance());
}

std::array<GroundDirection, 2> levelDirections(const GroundNormal& ground) {
  constexpr double kUpright = 1e-6;  // of the optical axis
  const Eigen::Vector3d& normal = ground.vector();
  const Eigen::Matrix3d& covariance = ground.covariance();
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ() - normal.z() * normal;
  const Eigen::Vector3d forward = ahead.norm() > kUpright ? ahead.normalized() : normal.unitOrthogonal();
  const Eigen::Vector3d left = forward.cross(normal);
  // Only the error out of the plane counts.
  const Eigen::Matrix3d along = normal * normal.transpose();
  return {GroundDirection(forward, forward.dot(covariance * forward) * along),
          GroundDirection(left, left.dot(covariance * left) * along)};
}

GroundNormal weightedMean(const GroundNormal& a, const GroundNormal& b) {
  const Eigen::Matrix<double, 3, 2> across = tangents(a.vector());
  const Eigen::Matrix2d of_a = across.transpose() * a.covariance() * across;
  const Eigen::Matrix2d of_b = across.transpose() * b.covariance() * across;
  const Eigen::Matrix2d gain = of_a * (of_a + of_b).inverse();
  if (!gain.allFinite()) return a;
  const Eigen::Vector3d n =
      (a.vector() + across * gain * across.transpose() * (b.vector() - a.vector())).normalized();
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity() - n * n.transpose();
  return {n, level * across * (of_a - gain * of_a) * across.transpose() * level};
}

GroundPlane fuseDirection(const GroundPlane& plane, const GroundDirection& direction, double max_nis,
                          double* nis) {
  const Eigen::Vector3d& p = direction.vector();
  const double innovation = -p.dot(plane.g);
  const double noise = plane.g.dot(direction.covariance() * plane.g);
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

GroundPlane fuseNormal(const GroundPlane& plane, const GroundNormal& ground, double max_nis, double* nis) {
  GroundPlane fused = plane;
  double worst = 0;
  for (const GroundDirection& level : levelDirections(ground)) {
    double ratio = 0;
    fused = fuseDirection(fused, level, max_nis, &ratio);
    worst = ratio > worst || std::isnan(ratio) ? ratio : worst;
  }
  if (nis != nullptr) *nis = worst;
  return worst <= max_nis ? fused : plane;
}

}  // namespace uav_landing
