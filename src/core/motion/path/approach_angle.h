#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// Approach angle in general: asin(n.t / |t|), positive descending. n: unit ground normal, down; t: camera
/// motion, any length but 0. rad.
double approachAngle(const Eigen::Vector3d& normal, const Eigen::Vector3d& translation);

/// Variance of it, rad^2: covariance of n (rank 2) and of t's own components (any scale), independent.
double approachAngleVariance(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
                             const Eigen::Vector3d& translation,
                             const Eigen::Matrix3d& translation_covariance);

/// Eq (1): theta = atan(H/f) - atan(L/f) with H and L the heights of the vanishing line and of the focus of
/// expansion above the field-of-view centre, pixels. Equal to the general form at zero roll with the focus
/// of expansion on the vertical through the principal point.
double approachAngleEq1(double H, double L, double f);

}  // namespace uav_landing
