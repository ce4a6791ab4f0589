#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// How a small window of the reference image appears in the other image. The pixel at (dx, dy) from the
/// window's centre lies in the same row, at column position + scale dx + shear dy.
/// A plane with disparity a u + b v + c gives scale 1 - a and shear -b from left to right.
struct RowWarp {
  double scale = 1.0;
  double shear = 0.0;

  /// From (dx, dy) to the displacement in the other image.
  Eigen::Matrix2d matrix() const { return (Eigen::Matrix2d() << scale, shear, 0, 1).finished(); }
};

}  // namespace uav_landing
