#pragma once

#include <Eigen/Core>
#include <vector>

#include "uav_landing/failure.h"
#include "uav_landing/ground_plane.h"

namespace uav_landing {

/// What a ground plane must look like to be believed.
struct PlaneLimits {
  double max_roll = 0;   ///< rad
  double max_pitch = 0;  ///< rad
  int min_points = 0;
  double tolerance = 1.0;  ///< pixels of disparity in the consensus step
};

/// True when the plane lies below the camera with pitch and roll inside the limits.
bool isPlausibleGround(const Eigen::Vector3d& g, const PlaneLimits& limits);

/// A matched pixel with its disparity, or several that it may have before the plane is known.
struct DisparitySample {
  double u = 0, v = 0;
  double stddev = 0;             ///< pixels of disparity
  double disparity = 0;          ///< pixels
  std::vector<double> others{};  ///< further disparities that it may have instead; mostly none
};

/// Plane by consensus (MSAC over triples; fixed seed): the plausible plane with the most support. A pixel
/// that matches nearer than the plane stands above the ground and costs nothing; one that matches farther
/// would lie below it, which ground does not allow, and counts against the plane.
/// slope_range, when not null: bounds on the change of disparity per row of the planes drawn (the least
/// squares that follow may leave them).
struct Consensus {
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  double support = 0;  ///< about the number of agreeing samples
  double score = 0;    ///< support less the penalties: what planes are ranked by
  bool found = false;
};
Consensus findPlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                    const PlaneLimits& limits, int iterations, const Eigen::Vector2d* slope_range);

/// Weighted least squares with redescending (Tukey) weights around a first plane: points above the ground
/// do not pull it. Covariance from the normal matrix, scaled by the residuals where these are larger than
/// the claimed stddevs, and by how much they are alike in neighbouring points. agrees: per sample, 1 when on
/// the plane. bias_stddev: error common to all disparities, pixels; it does not average out and is added to
/// the covariance.
struct PlaneFit {
  GroundPlane plane;
  std::vector<char> agrees;
  int count = 0;
  Eigen::Matrix3d row_covariance = Eigen::Matrix3d::Zero();  ///< share of vertical disparities, 1/m^2
  double residual_stddev = 0;                                ///< pixels, robust
  /// m^2, by which the surface rises and falls about the plane, match errors taken off: so below zero by
  /// chance.
  double surface_variance = 0;
};
Expected<PlaneFit> refinePlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                               const Eigen::Vector3d& start, const PlaneLimits& limits, double bias_stddev);

}  // namespace uav_landing
