#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lines/segments/line_segments.h"

namespace uav_landing {

/// The lines of one rectified view, and its camera matrix.
struct ViewLines {
  const std::vector<LineSegment>& lines;
  Eigen::Matrix3d K;
};

/// Which lines run along the runway: one vector per view, with 1 for each line that does.
using LinesAlong = std::vector<std::vector<char>>;

/// Finds the lines along the runway when the ground is known from elsewhere. On known ground each line has
/// its own direction, the same in both views. So two long edges side by side are enough. The direction of the
/// runway is the one with the largest total length, counted as log(far / near) on the ground. Texture is
/// short on the ground, even where it is long in the image.
///
/// Returns nothing in three cases: too little length agrees, all of it is one edge, or another direction has
/// almost as much.
///
/// normal: ground normal, left camera frame; its covariance in rad^2. max_yaw: largest angle to the optical
/// axis, rad.
std::optional<LinesAlong> findLinesAlong(const std::vector<ViewLines>& views, const Eigen::Vector3d& normal,
                                         const Eigen::Matrix3d& normal_covariance, double max_yaw);

}  // namespace uav_landing
