#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// Whether a vector has the length 1 and its covariance is finite.
bool isUnitEstimate(const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance);
/// Throws std::invalid_argument unless it is. meant: what the vector is.
void requireUnitEstimate(const char* meant, const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance);
/// Largest error of a length that counts as 1. Messages of other programs may be rounded.
constexpr double kUnitRounding = 1e-3;

/// A unit vector with the covariance of its errors, rad^2. All numbers are finite: where nothing is known,
/// there is none (std::optional). Meaning: keeps one kind from being taken for the other.
template <class Meaning>
class UnitEstimate {
 public:
  /// Throws std::invalid_argument when these numbers are none.
  UnitEstimate(const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance)
      : vector_(vector), covariance_(covariance) {
    requireUnitEstimate(Meaning::kName, vector, covariance);
  }
  /// Of numbers that may be none.
  static std::optional<UnitEstimate> of(const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance) {
    if (!isUnitEstimate(vector, covariance)) return std::nullopt;
    return UnitEstimate(vector, covariance);
  }

  const Eigen::Vector3d& vector() const { return vector_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  Eigen::Vector3d vector_;
  Eigen::Matrix3d covariance_;
};

struct InGround {
  static constexpr const char* kName = "a direction in the ground";
};
struct DownToGround {
  static constexpr const char* kName = "a normal of the ground";
};
/// A direction that lies in the ground plane, such as the runway's vanishing direction.
using GroundDirection = UnitEstimate<InGround>;
/// The unit normal of the ground, pointing down.
using GroundNormal = UnitEstimate<DownToGround>;

/// Nothing without a plane.
std::optional<GroundNormal> normalOf(const GroundPlane& plane);
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
