#pragma once

#include <optional>

#include "geometry/ground_normal.h"
#include "height/attitude_filter.h"
#include "landing/height/pair_input.h"
#include "landing/height/surface_ahead.h"
#include "rig/rig_rotation_filter.h"
#include "uav_landing/parameters/kalman_height_parameters.h"

namespace uav_landing {

/// The ground as this pair and the previous ones show it.
struct Ground {
  Failure failure;    ///< why the pair has no plane
  GroundPlane plane;  ///< of the surface ahead, from all sources; NaN when there is none
  /// Part of the plane's covariance from errors that all pairs have in common.
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();
  /// Plane from stereo alone, corrected by what was learned about the rig.
  GroundPlane alone;
  Eigen::Matrix3d alone_common = Eigen::Matrix3d::Zero();
  /// Variance of the height from the rig's rotation, m^2. Without a plane it keeps its last value.
  double rig_variance = 0;
  SurfaceAhead::Shape surface;         ///< from the plane ahead to the ground below
  std::optional<GroundNormal> normal;  ///< averaged over pairs; there is one when the plane is valid

  /// Angle to the normal of the previous pairs, rad, and the squared normalised difference.
  double tilt = kUnknown, tilt_ratio = kUnknown;
  /// The plane contradicts the previous pairs, so it gives no height, speed or position.
  bool tilted = false;
  bool turn_doubted = false, attitude_settled = true;  ///< see AttitudeFilter

  /// The averaged normal, or `otherwise` when there is no plane.
  std::optional<GroundNormal> normalOr(const std::optional<GroundNormal>& otherwise) const {
    return normal ? normal : otherwise;
  }
  /// Normal of the ground for positions: that of this pair, the averaged one if the plane is tilted, or
  /// `otherwise` when there is no plane.
  Eigen::Vector3d positionNormalOr(const Eigen::Vector3d& otherwise) const;
};

/// Estimates the ground ahead. It takes the plane of a pair, removes the effect of the rig's rotation and
/// fuses the plane with other knowledge about the ground. It also gives the bend of the surface and the
/// average of the normal over pairs.
class GroundEstimate {
 public:
  GroundEstimate(const StereoRig& rig, const KalmanHeightParameters& parameters);

  /// Estimates the ground of one pair. rig_doubted: the pair's vertical disparities must not be used for the
  /// rig. known: there is already a height.
  Ground propose(const PairInput& in, bool rig_doubted, bool known);
  /// Call it after the tests of the pair. believed: learn what this pair says about the rig. turned: new
  /// rotation of the rig, from which learning starts again.
  void commit(bool believed, const std::optional<RigRotation>& turned);
  RigRotation rigRotation() const { return rig_rotation_.rotation(); }

 private:
  void findPlane(const PairInput& in, bool rig_doubted, Ground& ground);
  void watchRig(const PairInput& in, bool rig_doubted, Ground& ground);
  void turnInto(const GroundDirection& direction, Ground& ground) const;
  RigRotationFilter::Others otherSources(const PairInput& in) const;
  void averageNormal(const PairInput& in, Ground& ground);

  StereoRig rig_;
  KalmanHeightParameters parameters_;
  RigRotationFilter rig_rotation_;
  SurfaceAhead surface_;
  AttitudeFilter attitude_;
  double rig_variance_ = 0;  // for the last plane, m^2
};

}  // namespace uav_landing
