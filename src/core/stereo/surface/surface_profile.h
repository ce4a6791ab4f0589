#pragma once

#include <array>
#include <optional>
#include <vector>

#include "stereo/plane/plane_fit.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Shares of slope_change that a surface may bend by, and how likely each of them is taken to be for what the
/// covariance must hold; the rest is for a plane.
constexpr std::array<double, 4> kBendShares = {1.0 / 16, 1.0 / 4, 1, 2};
constexpr double kBendChance = 0.1;

/// The surface ahead where it is not a plane: its curvature along the line of sight is a random one that is
/// alike over some 100 m.
struct SurfaceProfile {
  /// Tangent plane straight below the camera: its height is the clearance.
  GroundPlane below;
  /// Mean change of slope over distance, from below the camera to the farthest sample; positive in a sag.
  /// 1/m.
  double curvature = 0;
  double curvature_variance = 0;  ///< 1/m^2
};

/// Fits plane and profile to disparities that are good to their stddevs. flat: plane through all of them,
/// where the fit starts. slope_change: 1 sigma by which slopes may change over 100 m, rad; how much of it
/// this surface has, nothing included, is found from the disparities by their likelihood, and where they
/// leave that open the mean and the covariance are those of the mixture. limits, bias_stddev: as for
/// refinePlane. Nothing where there are too few samples, or too near each other.
std::optional<SurfaceProfile> fitSurfaceProfile(const StereoRig& rig,
                                                const std::vector<DisparitySample>& samples,
                                                const PlaneFit& flat, const PlaneLimits& limits,
                                                double bias_stddev, double slope_change);

}  // namespace uav_landing
