#pragma once

#include <Eigen/Core>
#include <vector>

#include "lines/segments/line_segment.h"
#include "lines/vanishing/vanishing_point.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Vanishing point of the runway (paper, section 2): RANSAC over pairs of lines, then least squares on the
/// sphere over the inliers. RANSAC ends when pairs of the best point must have been drawn often. The fit uses
/// great circles K' l, weighted by the lines' own uncertainty, and scales the covariance by the residuals.
/// Deterministic: the random numbers have a fixed seed.
/// K: 3x3 of the rectified view. Only directions within max_yaw and max_elevation of the optical axis count
/// as along the runway. prior_normal: ground normal known from elsewhere, or null; with it, the direction
/// must lie within 5 degrees of the ground.
/// Fails in four cases. Too few lines meet. As many lines of random direction would meet. The lines are
/// parallel in the image within 3 degrees (all from one edge). The direction is uncertain by more than 5
/// degrees.
Expected<VanishingPoint> findVanishingPoint(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                            const ApproachAngleParameters& parameters,
                                            const Eigen::Vector3d* prior_normal = nullptr);

/// The same fit to lines that are known to be along the runway (members: 1), at least two. Fails as above,
/// but does not test whether they could meet by chance.
Expected<VanishingPoint> fitVanishingPoint(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                           const ApproachAngleParameters& parameters,
                                           const std::vector<char>& members,
                                           const Eigen::Vector3d* prior_normal = nullptr);

}  // namespace uav_landing
