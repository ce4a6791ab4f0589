#pragma once

#include "geometry/plane_vector.h"
#include "stereo/matching/plane_drift.h"
#include "stereo/matching/row_warp.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Column shift u_l - u_r = a u + b v + c between the images of a rig, for a plane. Rows
/// stay. With a rolling shutter the plane's drift is added, with the row times approximated by a plane over
/// the image.
class ShiftModel {
 public:
  double a, b, c;
  ShiftModel(const StereoRig& rig, const PlaneVector& plane, const PlaneDrift& drift = {}) {
    const Eigen::Vector3d& g = plane;
    a = rig.fb() * g.x() / rig.fx;
    b = rig.fb() * g.y() / rig.fy;
    c = rig.fb() * g.dot(rig.ray(0, 0)) + rig.principalOffset();
    still_ = drift.isStill();
    if (still_) return;
    const Eigen::Vector3d& rate = drift.rate;
    rate_ = rig.fb() * Eigen::Vector3d(rate.dot(rig.ray(0, 0)), rate.x() / rig.fx, rate.y() / rig.fy);
    times_ = drift.times->plane();
  }
  double at(double u, double v) const {
    const double plane = a * u + b * v + c;
    return still_ ? plane : plane + drift(u, v);
  }
  /// A model without drift that equals this one around a pixel, to first order.
  ShiftModel around(double u, double v) const {
    if (still_) return *this;
    ShiftModel tangent = *this;
    const Eigen::Vector3d place(1, u, v);
    const double rate = rate_.dot(place), time = times_.dot(place);
    tangent.still_ = true;
    tangent.a += rate_[1] * time + rate * times_[1];
    tangent.b += rate_[2] * time + rate * times_[2];
    tangent.c += at(u, v) - tangent.at(u, v);
    return tangent;
  }
  RowWarp forward() const { return {1 - a, -b}; }
  RowWarp backward() const { return {1 / (1 - a), b / (1 - a)}; }

 private:
  double drift(double u, double v) const {
    const Eigen::Vector3d place(1, u, v);
    return rate_.dot(place) * times_.dot(place);
  }

  bool still_ = true;
  // Coefficients of 1, u, v: drift in pixels per second, and row times in seconds.
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero(), times_ = Eigen::Vector3d::Zero();
};

}  // namespace uav_landing
