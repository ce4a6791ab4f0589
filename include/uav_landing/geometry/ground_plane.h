#pragma once

#include <Eigen/Core>
#include <cmath>

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// The ground as seen from the rectified left camera: g = n / h, with the unit normal n pointing down and the
/// height h. A ground point X has g.X = 1. A ground pixel with the ray r has the disparity d = f b g.r, which
/// is linear in (u, v). The three numbers contain height, pitch and roll.
struct GroundPlane {
  Eigen::Vector3d g = Eigen::Vector3d::Constant(std::nan(""));           ///< 1/m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(std::nan(""));  ///< of g, 1/m^2

  bool valid() const { return g.allFinite() && g.norm() > 0; }
  double height() const { return 1.0 / g.norm(); }
  Eigen::Vector3d normal() const { return g.normalized(); }
  double heightVariance() const;             ///< m^2, first order
  Eigen::Matrix3d normalCovariance() const;  ///< of n, rank 2
  double inverseDepth(const Eigen::Vector3d& ray) const { return g.dot(ray); }
  double disparity(const StereoRig& rig, double u, double v) const { return rig.fb() * g.dot(rig.ray(u, v)); }
};

/// Pitch = -asin(n_z), rad: elevation of the optical axis above the plane. It is negative when looking down.
double pitchOf(const Eigen::Vector3d& normal);
/// Roll = atan2(n_x, n_y), rad. It is positive with the right side down.
double rollOf(const Eigen::Vector3d& normal);
/// First-order variances of pitch and roll from the covariance of the normal, rad^2.
double pitchVariance(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance);
double rollVariance(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance);
/// Normal of the ground for a camera with this attitude, rad. This is the inverse of pitchOf() and rollOf().
Eigen::Vector3d normalFromPitchRoll(double pitch, double roll);
/// Horizon l = K^-T n. Pixels (u, v) with l.[u v 1] = 0 have disparity zero.
Eigen::Vector3d horizonLine(const StereoRig& rig, const Eigen::Vector3d& normal);

/// Yaw of the camera, rad: angle of the optical axis from the landing direction about the up axis. It is
/// positive to the left.
double yawOf(const Eigen::Vector3d& normal, const Eigen::Vector3d& landing_direction);

}  // namespace uav_landing
