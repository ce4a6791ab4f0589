#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

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

/// Fuses a stereo plane with an independent unit direction p that lies in the ground plane (p.g = 0), such as
/// a vanishing point. It is a scalar Kalman update in Joseph form. p_covariance: of p, 3x3, rank 2, rad^2.
/// nis: gets the test ratio (squared innovation over variance). Beyond max_nis the plane is returned
/// unchanged.
GroundPlane fuseVanishingPoint(const GroundPlane& plane, const Eigen::Vector3d& p,
                               const Eigen::Matrix3d& p_covariance, double max_nis, double* nis);

/// A direction that lies in the ground plane. NaN: not known.
struct GroundDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());  ///< unit
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();                                             ///< rad^2

  bool known() const { return direction.allFinite() && covariance.allFinite(); }
};
/// A unit normal of the ground from another source. NaN: not known.
struct GroundNormal {
  Eigen::Vector3d n = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< rad^2

  bool known() const { return n.allFinite() && covariance.allFinite(); }
};
/// Mean of two independent normals, weighted by their covariances.
GroundNormal weightedMean(const GroundNormal& a, const GroundNormal& b);
/// The normal as two directions in the ground plane: forward (the optical axis above the ground) and left.
std::array<GroundDirection, 2> levelDirections(const GroundNormal& ground);

/// Fuses a plane with a normal that is independent of stereo, such as that of an attitude sensor, in the same
/// way. nis: gets the larger test ratio of the two directions. Beyond max_nis the plane is returned
/// unchanged.
GroundPlane fuseNormal(const GroundPlane& plane, const GroundNormal& ground, double max_nis, double* nis);

/// Yaw of the camera, rad: angle of the optical axis from the landing direction about the up axis. It is
/// positive to the left.
double yawOf(const Eigen::Vector3d& normal, const Eigen::Vector3d& landing_direction);

}  // namespace uav_landing
