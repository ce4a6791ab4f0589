#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// A unit vector with the covariance of its errors (rad^2). All numbers are finite: where nothing is known,
/// there is none (std::optional).
class UnitVectorEstimate {
 public:
  /// Largest error of a length that counts as 1. Messages of other programs may be rounded.
  static constexpr double kRounding = 1e-3;

  const Eigen::Vector3d& vector() const { return vector_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 protected:
  UnitVectorEstimate(const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance)
      : vector_(vector), covariance_(covariance) {}
  static bool holds(const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance);
  /// Throws std::invalid_argument that names what was meant.
  static void refuse(const char* meant, const Eigen::Vector3d& vector);

 private:
  Eigen::Vector3d vector_;
  Eigen::Matrix3d covariance_;
};

/// A direction that lies in the ground plane, such as the runway's vanishing direction.
class GroundDirection : public UnitVectorEstimate {
 public:
  /// Throws std::invalid_argument when the vector has not the length 1, or a number is not finite.
  GroundDirection(const Eigen::Vector3d& direction, const Eigen::Matrix3d& covariance);
  /// Nothing when these numbers are none.
  static std::optional<GroundDirection> of(const Eigen::Vector3d& direction,
                                           const Eigen::Matrix3d& covariance);
};

/// The unit normal of the ground, pointing down.
class GroundNormal : public UnitVectorEstimate {
 public:
  /// Throws std::invalid_argument when the vector has not the length 1, or a number is not finite.
  GroundNormal(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance);
  /// Nothing when these numbers are none.
  static std::optional<GroundNormal> of(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance);
  static std::optional<GroundNormal> of(const GroundPlane& plane);
};

/// Mean of two independent normals, weighted by their covariances.
GroundNormal weightedMean(const GroundNormal& a, const GroundNormal& b);
/// The normal as two directions in the ground plane: forward (the optical axis above the ground) and left.
std::array<GroundDirection, 2> levelDirections(const GroundNormal& ground);

/// Fuses a stereo plane with a direction in the ground that is independent of it, such as a vanishing point
/// (p.g = 0). It is a scalar Kalman update in Joseph form. nis: gets the test ratio (squared innovation over
/// variance). Beyond max_nis the plane is returned unchanged.
GroundPlane fuseDirection(const GroundPlane& plane, const GroundDirection& direction, double max_nis,
                          double* nis);
/// Fuses a plane with a normal that is independent of stereo, such as that of an attitude sensor, in the same
/// way. nis: gets the larger test ratio of the two directions. Beyond max_nis the plane is returned
/// unchanged.
GroundPlane fuseNormal(const GroundPlane& plane, const GroundNormal& ground, double max_nis, double* nis);

}  // namespace uav_landing
