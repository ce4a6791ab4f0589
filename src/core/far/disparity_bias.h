#pragma once

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The error that all disparities have in common, from pair to pair: a yaw of the right camera, or its
/// principal point.
///
/// Near the ground it hardly matters. From afar it is a good part of the runway's disparity. It tilts the
/// ground's plane by stereo, and leaves alone the normal that the motion in the left image asks for. So both
/// together tell it.
class DisparityBias {
 public:
  explicit DisparityBias(const StereoRig& rig) : rig_(rig) {}

  /// Begins a pair. calibrated: 1 sigma that the calibration leaves, px.
  void predict(double stamp, double calibrated);
  /// Takes in what the pair says. plane: by stereo, not valid when there is none. motion: its normal is used.
  void update(const GroundPlane& plane, const ApproachAngleResult::Motion& motion);

  double value() const { return value_; }        ///< px
  double variance() const { return variance_; }  ///< px^2
  /// The plane without the bias. Its covariance holds what is left, instead of what the calibration leaves.
  GroundPlane corrected(GroundPlane plane) const;

 private:
  StereoRig rig_;
  double stamp_ = kUnknown, calibrated_ = 0;
  double value_ = 0, variance_ = 0;
};

}  // namespace uav_landing
