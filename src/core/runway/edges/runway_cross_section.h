#pragma once

#include <Eigen/Core>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

constexpr double kStripeShare = 0.1;  // of the runway's width; the line along the middle is narrower

/// Position of the runway across the landing direction. Units are multiples of the left camera's height; left
/// of the camera is positive.
struct RunwayCrossSection {
  double centre = 0, variance = 0;       ///< of the centre line, where it passes the camera
  double width = 0, width_variance = 0;  ///< between the outermost long edges
  double turn = 0;  ///< of the runway's direction from the axes' forward, to the left, rad
  /// Covariance of (centre, turn) if the normal were exact.
  Eigen::Matrix2d own = Eigen::Matrix2d::Zero();
  /// Derivatives of (centre, turn) and of the width by rotations of the ground normal about forward and about
  /// left.
  Eigen::Matrix2d by_normal = Eigen::Matrix2d::Zero();
  Eigen::RowVector2d width_by_normal = Eigen::RowVector2d::Zero();
  CentreSolutions centre_without = {};  ///< the centre without each of its sources
};

}  // namespace uav_landing
