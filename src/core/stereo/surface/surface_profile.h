#pragma once

#include <array>
#include <optional>
#include <vector>

#include "stereo/plane/plane_fit.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Shares of slope_change by which a surface may bend, and the probability of each for the covariance. The
/// rest of the probability is for a plane.
constexpr std::array<double, 4> kBendShares = {1.0 / 16, 1.0 / 4, 1, 2};
constexpr double kBendChance = 0.1;

/// The surface ahead when it is not a plane. Its curvature along the line of sight is random, and stays alike
/// over some 100 m.
struct SurfaceProfile {
  /// Tangent plane straight below the camera; its height is the clearance.
  GroundPlane below;
  /// Mean change of slope over distance, from below the camera to the farthest sample, 1/m. Positive in a
  /// sag.
  double curvature = 0;
  double curvature_variance = 0;  ///< 1/m^2
};

/// Fits plane and profile to disparities whose stddevs are true. flat: plane through all of them, where the
/// fit starts. slope_change: 1 sigma of the change of slope over 100 m, rad. limits: as for refinePlane().
/// The likelihood of the disparities decides how much of slope_change this surface has; it may have none.
/// While that is open, mean and covariance are those of the mixture. Nothing when there are too few samples,
/// or when they are too near each other.
std::optional<SurfaceProfile> fitSurfaceProfile(const StereoRig& rig, const Disparities& disparities,
                                                const PlaneFit& flat, const PlaneLimits& limits,
                                                double slope_change);

}  // namespace uav_landing
