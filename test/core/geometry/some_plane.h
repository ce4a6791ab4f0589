#pragma once

#include <cmath>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// A plane 12 m below a camera that looks down and rolls, with errors that depend on each other.
inline GroundPlane somePlane() {
  constexpr double kDegree = M_PI / 180;
  GroundPlane plane;
  plane.g = normalFromPitchRoll(-8 * kDegree, 5 * kDegree) / 12.0;
  Eigen::Matrix3d L;
  L << 3e-4, 0, 0, 1e-4, 2e-4, 0, -1e-4, 2e-4, 4e-4;
  plane.covariance = L * L.transpose();
  return plane;
}

}  // namespace uav_landing
