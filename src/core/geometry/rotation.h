#pragma once

#include <Eigen/Geometry>

#include "geometry/cross_matrix.h"

namespace uav_landing {

// Rotations by their vectors (axis times angle, rad), and directions by their tangents.

inline Eigen::Matrix3d rotationMatrix(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + crossMatrix(w);
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

inline Eigen::Vector3d rotationVector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

/// Two unit vectors that span the plane perpendicular to a unit vector.
inline Eigen::Matrix<double, 3, 2> tangents(const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 3, 2> B;
  B.col(0) = direction.unitOrthogonal();
  B.col(1) = direction.cross(B.col(0));
  return B;
}

}  // namespace uav_landing
