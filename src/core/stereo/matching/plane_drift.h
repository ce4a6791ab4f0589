#pragma once

#include <Eigen/Core>
#include <vector>

#include "results/disparity_sample.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"

namespace uav_landing {

/// Change of the ground plane while a rolling shutter reads the rows. A row sees g carried to the time of
/// that row: d(u, v) = f b (g + rate t(u, v)).r. By default all rows are exposed at the stamp.
struct PlaneDrift {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< of g, 1/m/s
  const RowTimes* times = nullptr;                 ///< of the left image

  bool isStill() const { return times == nullptr || times->atOnce(); }
};

/// Subtracts the drift from the disparities, so that they are those at the stamp.
void carryToStamp(const StereoRig& rig, const PlaneDrift& drift, std::vector<DisparitySample>& samples);

/// Derivative A of the fitted plane by the drift's rate, in seconds: dg = A d(rate). The plane was fitted to
/// samples that carryToStamp() had corrected by that rate. agrees: 1 for samples on the plane. Zero
/// without times.
Eigen::Matrix3d planeByRate(const StereoRig& rig, const PlaneDrift& drift,
                            const std::vector<DisparitySample>& samples, const std::vector<char>& agrees);

}  // namespace uav_landing
