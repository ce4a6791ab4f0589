#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/rotation.h"
#include "geometry/stamp_map.h"

namespace uav_landing {

// Motion is scale-free here: lengths are in units of the height now, so that the ground plane is the unit
// normal n (n.X = 1 on it) and t is t / h.

/// Camera motion from a frame then to the frame now: x_now = R x_then - t, t in the frame now.
struct CameraMotion {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  /// Where the point on the ray r (third component 1) at inverse depth w was seen then, up to scale.
  Eigen::Vector3d seenThen(const Eigen::Vector3d& r, double w) const { return R.transpose() * (r + w * t); }
};

/// The same motion for so many times as long.
inline CameraMotion carriedOn(const CameraMotion& motion, double times) {
  const Eigen::AngleAxisd turn(motion.R);
  return {Eigen::AngleAxisd(turn.angle() * times, turn.axis()).toRotationMatrix(), motion.t * times};
}

/// How the camera moves now if it has moved evenly over the duration (s) of that motion.
inline RowMotion evenMotion(const CameraMotion& motion, double duration) {
  return {rotationVector(motion.R) / duration, motion.t / duration};
}

/// Rotation from then to now that is known beforehand, of an inertial sensor.
struct RotationPrior {
  Eigen::Matrix3d R;
  Eigen::Matrix3d covariance;  ///< of its rotation vector, in the frame now, rad^2
};

}  // namespace uav_landing
