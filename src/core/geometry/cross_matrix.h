#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// The matrix M for which M a is the cross product of v and a.
inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace uav_landing
