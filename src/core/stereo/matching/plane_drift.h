#pragma once

#include <Eigen/Core>
#include <vector>

#include "results/disparity_sample.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"

namespace uav_landing {

/// The plane that a row sees is g carried to the time of that row: d(u, v) = f b (g + rate t(u, v)).r. The
/// default is a pair whose rows are all exposed at the stamp.
struct PlaneDrift {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< of g, 1/m/s
  const RowTimes* times = nullptr;                 ///< of the left image

  bool isStill() const { return times == nullptr || times->atOnce(); }
};

/// Takes from the disparities what the drift adds, so that they are those at the stamp.
void carryToStamp(const StereoRig& rig, const PlaneDrift& drift, std::vector<DisparitySample>& samples);

/// How a plane that was fitted to samples carried to the stamp follows the rate they were carried with: dg =
/// A d(rate), in seconds. agrees: those that are on the plane.
Eigen::Matrix3d planeByRate(const StereoRig& rig, const PlaneDrift& drift,
                            const std::vector<DisparitySample>& samples, const std::vector<char>& agrees);

}  // namespace uav_landing
