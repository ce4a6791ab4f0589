#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/rotation.h"
#include "geometry/stamp_map.h"

namespace uav_landing {

// Motion has no scale here: the unit of length is the height now. So the ground plane is the unit normal n
// (n.X = 1 on it), and the translation is t = translation / height.

/// Camera motion from a frame then to the frame now: x_now = R x_then - t. The translation t is in the frame
/// now.
struct CameraMotion {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  /// Direction in which a point was seen then, not normalised. The point lies on the ray r (third component
  /// 1) at the inverse depth w.
  Eigen::Vector3d seenThen(const Eigen::Vector3d& r, double w) const { return R.transpose() * (r + w * t); }
};

/// Extrapolates a motion to `times` its duration. Rotation and translation grow in proportion.
inline CameraMotion carriedOn(const CameraMotion& motion, double times) {
  const Eigen::AngleAxisd turn(motion.R);
  return {Eigen::AngleAxisd(turn.angle() * times, turn.axis()).toRotationMatrix(), motion.t * times};
}

/// Rotation from then to now as an inertial sensor measured it, independent of the images.
struct RotationPrior {
  Eigen::Matrix3d R;
  Eigen::Matrix3d covariance;  ///< of the rotation vector of R, in the frame now, rad^2
};

}  // namespace uav_landing
