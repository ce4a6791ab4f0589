#pragma once

#include <vector>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Eq (3): depth Y_c = f b / d, metres. d: disparity, pixels, must be positive.
double depthFromDisparity(const StereoRig& rig, double disparity);

/// Eq (4): rotates the point (x_c, y_c, z_c) of the paper's camera axes (right, depth, down) about x by the
/// angle theta (rad) to the paper's world axes. Our camera axes (X, Y, Z) are its (x_c, z_c, y_c).
Eigen::Vector3d rotateToWorld(const Eigen::Vector3d& paper_point, double theta);

/// Eq (5): height of the camera over one ground point, z_w = y_c sin(theta) + z_c cos(theta).
double heightOverPoint(double y_c, double z_c, double theta);

/// Mean of eq (5) over points, with its variance. NaN when there is no point with positive disparity.
struct AveragedHeight {
  double height = kUnknown;
  double variance = kUnknown;  ///< of the mean, from the scatter of the points
  int points = 0;
};
/// theta: angle of eqs (4), (5), rad: minus the camera's pitch (or, to the letter of the paper, the approach
/// angle). roll: removed from the points first, rad; 0 for the paper. only_on_plane: skip points off the
/// ground plane.
AveragedHeight averageHeight(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                             double theta, double roll, bool only_on_plane);

}  // namespace uav_landing
