#pragma once

#include "height/attitude_filter.h"
#include "landing/height/pair_input.h"
#include "landing/height/surface_ahead.h"
#include "rig/rig_rotation_filter.h"
#include "uav_landing/parameters/kalman_height_parameters.h"

namespace uav_landing {

/// What a pair, and those before, say of the ground.
struct Ground {
  Failure failure;    ///< why the pair has no plane
  GroundPlane plane;  ///< of the surface ahead, by all that is known; NaN when there is none
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();  ///< share of its covariance that all pairs have
  GroundPlane alone;                                 ///< by stereo, and by what was learned of the rig, alone
  Eigen::Matrix3d alone_common = Eigen::Matrix3d::Zero();
  double rig_variance = 0;      ///< of the height, by the rig's rotation; without a plane as before, m^2
  SurfaceAhead::Shape surface;  ///< from the plane ahead to the ground below
  GroundNormal normal;          ///< averaged over the pairs; set when the plane is valid

  double tilt = kUnknown, tilt_ratio = kUnknown;  ///< against the pairs before: rad, squared and normalised
  bool tilted = false;  ///< the plane contradicts those before: no height, speed or place by it
  bool turn_doubted = false, attitude_settled = true;  ///< see AttitudeFilter

  /// The averaged normal; without a plane otherwise.
  GroundNormal normalOr(const GroundNormal& otherwise) const { return plane.valid() ? normal : otherwise; }
  /// Of the ground that positions refer to: by this pair, unless it is tilted; without a plane otherwise.
  Eigen::Vector3d positionNormalOr(const Eigen::Vector3d& otherwise) const;
};

/// The ground ahead: the plane of a pair freed of the rig's rotation and fused with what else is known of the
/// ground, its bend, and its normal averaged over the pairs.
class GroundEstimate {
 public:
  GroundEstimate(const StereoRig& rig, const KalmanHeightParameters& parameters);

  /// rig_doubted: the pair's vertical disparities say nothing of the rig. known: there is a height already.
  Ground propose(const PairInput& in, bool rig_doubted, bool known);
  /// After the tests of the pair. believed: what it says of the rig is learned. turned: another rotation than
  /// before is the rig's from now on.
  void commit(bool believed, const std::optional<RigRotation>& turned);
  RigRotation rigRotation() const { return rig_rotation_.rotation(); }

 private:
  void findPlane(const PairInput& in, bool rig_doubted, Ground& ground);
  void watchRig(const PairInput& in, bool rig_doubted, Ground& ground);
  void fuseDirection(const GroundDirection& direction, Ground& ground) const;
  RigRotationFilter::Others otherSources(const PairInput& in) const;
  void averageNormal(const PairInput& in, Ground& ground);

  StereoRig rig_;
  KalmanHeightParameters parameters_;
  RigRotationFilter rig_rotation_;
  SurfaceAhead surface_;
  AttitudeFilter attitude_;
  double rig_variance_ = 0;  // of the last height, m^2
};

}  // namespace uav_landing
