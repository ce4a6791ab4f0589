#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/plane_limits.h"
#include "kernels/samples/plane_sums.h"
#include "results/disparity_sample.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// Weighted least squares with redescending (Tukey) weights around a first plane: points above the ground
/// do not pull it. start: among most of the points; the weights see nothing that is off by more than four
/// times what it claims. Covariance from the normal matrix, scaled by the residuals where these are larger
/// than the claimed stddevs, and by how much they are alike in neighbouring points. agrees: per sample, 1
/// when on the plane. bias_stddev: error common to all disparities, pixels; it does not average out and is
/// added to the covariance. memory: to work in, of any fit before.
struct PlaneFit {
  GroundPlane plane;
  std::vector<char> agrees;
  int count = 0;
  Eigen::Matrix3d row_covariance = Eigen::Matrix3d::Zero();  ///< share of vertical disparities, 1/m^2
  double lasting_share = 0;    ///< of the covariance without bias and rows, what is no noise of the images
  double residual_stddev = 0;  ///< pixels, robust
};
Expected<PlaneFit> refinePlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                               const Eigen::Vector3d& start, const PlaneLimits& limits, double bias_stddev,
                               PlaneColumns& memory);
/// The same with memory of its own.
Expected<PlaneFit> refinePlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                               const Eigen::Vector3d& start, const PlaneLimits& limits, double bias_stddev);

}  // namespace uav_landing
