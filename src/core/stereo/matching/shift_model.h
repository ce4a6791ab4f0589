#pragma once

#include "stereo/matching/row_warp.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Column shift u_l - u_r = a u + b v + c between the images of a rig, of the plane vector g (1/m). Rows
/// stay.
struct ShiftModel {
  double a, b, c;
  ShiftModel(const StereoRig& rig, const Eigen::Vector3d& g) {
    a = rig.fb() * g.x() / rig.fx;
    b = rig.fb() * g.y() / rig.fy;
    c = rig.fb() * g.dot(rig.ray(0, 0)) + rig.principalOffset();
  }
  double at(double u, double v) const { return a * u + b * v + c; }
  RowWarp forward() const { return {1 - a, -b}; }
  RowWarp backward() const { return {1 / (1 - a), b / (1 - a)}; }
};

}  // namespace uav_landing
