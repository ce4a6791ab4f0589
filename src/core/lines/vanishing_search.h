#pragma once

#include <Eigen/Core>
#include <vector>

#include "lines/line_segment.h"
#include "lines/vanishing_point.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// RANSAC (paper, section 2) over pairs of lines (until those of the best point must have been drawn often),
/// then least squares on the sphere over the inliers (great circles K' l, weighted by the lines' own
/// uncertainty, scaled by the residuals). Only directions within max_yaw and max_elevation of the optical
/// axis count as along the runway. K: 3x3 of the rectified view. Deterministic: the random numbers have a
/// fixed seed. prior_normal: ground normal known from elsewhere, or null; then the direction must lie within
/// 5 degrees of the ground. Fails when too few lines meet, when as many lines of random direction would, when
/// the lines are parallel in the image within 3 degrees (all from one edge), and when the direction is
/// uncertain by more than 5 degrees.
Expected<VanishingPoint> findVanishingPoint(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                            const ApproachAngleParameters& parameters,
                                            const Eigen::Vector3d* prior_normal = nullptr);

/// The same fit to lines that are known to be along the runway (members: 1), at least two. Fails as above,
/// but does not ask whether they could meet by chance.
Expected<VanishingPoint> fitVanishingPoint(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                           const ApproachAngleParameters& parameters,
                                           const std::vector<char>& members,
                                           const Eigen::Vector3d* prior_normal = nullptr);

}  // namespace uav_landing
