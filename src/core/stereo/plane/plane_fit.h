#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/plane_limits.h"
#include "geometry/plane_vector.h"
#include "kernels/samples/plane_sums.h"
#include "results/disparity_sample.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// Disparities of one pair.
struct Disparities {
  const std::vector<DisparitySample>& samples;
  /// 1 sigma of an error common to all of them, pixels. It does not average out.
  double bias_stddev = 0;
};

/// A plane that was fitted to disparities.
struct PlaneFit {
  GroundPlane plane;
  std::vector<char> agrees;  ///< per sample, 1 when on the plane
  int count = 0;
  Eigen::Matrix3d row_covariance = Eigen::Matrix3d::Zero();  ///< part from vertical disparities, 1/m^2
  double lasting_share = 0;    ///< of the covariance without bias and rows: what is not noise of the images
  double residual_stddev = 0;  ///< pixels, robust
};

/// Weighted least squares with redescending (Tukey) weights around a first plane. So points above the ground
/// do not pull. The covariance comes from the normal matrix. It is scaled by the residuals when these exceed
/// the claimed stddevs, and by how alike they are in neighbouring points. The variance of the common error is
/// added to it.
/// start: a plane near most points. Samples off it by more than four times their stddev have no weight.
/// memory: to work in, from any earlier fit.
Expected<PlaneFit> refinePlane(const StereoRig& rig, const Disparities& disparities, const PlaneVector& start,
                               const PlaneLimits& limits, PlaneColumns& memory);
/// The same with memory of its own.
Expected<PlaneFit> refinePlane(const StereoRig& rig, const Disparities& disparities, const PlaneVector& start,
                               const PlaneLimits& limits);

}  // namespace uav_landing
