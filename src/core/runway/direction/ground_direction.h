#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lines/segments/line_segments.h"

namespace uav_landing {

/// The lines of one rectified view.
struct ViewLines {
  const std::vector<LineSegment>& lines;
  Eigen::Matrix3d K;
};

/// Which lines run along the runway; one vector a view, 1 for those that do.
using LinesAlong = std::vector<std::vector<char>>;

/// The lines along the runway when the ground is known from elsewhere. On known ground each line has a
/// direction of its own, the same in both views, so that two long edges side by side are enough: the runway's
/// direction is that of most length, counted as log(far / near) on the ground. Texture is short on the
/// ground, however long it is in the picture. Nothing when too little length agrees, when all of it is one
/// edge, or when another direction comes near it. normal: of the ground, left camera frame, covariance in
/// rad^2. max_yaw: largest angle to the optical axis, rad.
std::optional<LinesAlong> findLinesAlong(const std::vector<ViewLines>& views, const Eigen::Vector3d& normal,
                                         const Eigen::Matrix3d& normal_covariance, double max_yaw);

}  // namespace uav_landing
