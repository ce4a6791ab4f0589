#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// Where the runway lies across. Multiples of the left camera's height; left of the camera is positive.
struct RunwayCrossSection {
  double centre = 0, variance = 0;       ///< centre line where it passes the camera
  double width = 0, width_variance = 0;  ///< between the outermost long edges
  double turn = 0;  ///< of the runway's direction against the axes' forward, to the left, rad
  Eigen::Matrix2d own = Eigen::Matrix2d::Zero();  ///< covariance of (centre, turn) were the normal exact
  /// Derivatives of (centre, turn) and of the width by rotations of the normal about forward and about left.
  Eigen::Matrix2d by_normal = Eigen::Matrix2d::Zero();
  Eigen::RowVector2d width_by_normal = Eigen::RowVector2d::Zero();
};

}  // namespace uav_landing
