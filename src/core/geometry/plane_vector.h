#pragma once

#include <Eigen/Core>
#include <optional>

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// A plane vector g = n / h, 1/m (see GroundPlane). It is finite and not zero, so every one has a height and
/// a unit normal. Where no plane is known, there is none: see std::optional.
class PlaneVector {
 public:
  /// Throws std::invalid_argument for a vector that is zero or not finite, as no plane has it.
  explicit PlaneVector(const Eigen::Vector3d& g);
  /// The plane of a vector that may be none.
  static std::optional<PlaneVector> of(const Eigen::Vector3d& g);

  // A plane vector is a vector, but not the other way round.
  operator const Eigen::Vector3d&() const { return g_; }  // NOLINT(google-explicit-constructor)
  const Eigen::Vector3d& vector() const { return g_; }
  Eigen::Vector3d normal() const { return g_.normalized(); }
  double height() const { return 1 / g_.norm(); }  ///< m
  /// Disparity of its ground at a pixel of the left image, pixels.
  double disparity(const StereoRig& rig, double u, double v) const {
    return rig.fb() * g_.dot(rig.ray(u, v));
  }

 private:
  Eigen::Vector3d g_;
};

}  // namespace uav_landing
