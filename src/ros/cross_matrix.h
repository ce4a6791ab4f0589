#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// [v]x: that times u is v x u.
inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace uav_landing
