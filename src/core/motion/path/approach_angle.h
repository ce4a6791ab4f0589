#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// Approach angle in general: asin(n.t / |t|), rad, positive when descending. normal: unit normal of the
/// ground, pointing down. translation: of the camera, in any unit but not zero.
double approachAngle(const Eigen::Vector3d& normal, const Eigen::Vector3d& translation);

/// First-order variance of approachAngle(), rad^2. The errors of normal and translation are taken as
/// independent. normal_covariance: rank 2, rad^2. translation_covariance: in the square of the translation's
/// unit.
double approachAngleVariance(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
                             const Eigen::Vector3d& translation,
                             const Eigen::Matrix3d& translation_covariance);

/// Eq (1) of the paper: theta = atan(H/f) - atan(L/f). H and L are the heights of the vanishing line and of
/// the focus of expansion above the centre of the image, pixels. It equals the general form when roll is zero
/// and the focus of expansion lies straight above or below the principal point.
double approachAngleEq1(double H, double L, double f);

}  // namespace uav_landing
