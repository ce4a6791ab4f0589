#include "rig/pair_skew.h"

#include <cmath>

#include "estimation/aircraft.h"

namespace uav_landing {
namespace {

double meanInverseDepth(const StereoRig& rig, const StereoDepthResult& stereo) {
  double sum = 0;
  int count = 0;
  for (const StereoDepthResult::Point& point : stereo.points) {
    if (!point.on_plane) continue;
    sum += point.disparity;
    ++count;
  }
  return count == 0 ? 0 : sum / count / rig.fb();
}

}  // namespace

Eigen::Vector3d planeErrorOfSkew(const StereoRig& rig, const PlaneVector& plane, double mean_inverse_depth,
                                 const CameraRates& rates, double skew) {
  const Eigen::Vector3d& v = rates.velocity;
  const Eigen::Vector3d& w = rates.angular_velocity;
  const double q = mean_inverse_depth, b = rig.baseline;
  return skew / b * ((v.x() + b * q * v.z()) * plane.vector() + Eigen::Vector3d(-v.z() * q, -w.z(), w.y()));
}

GroundPlane withSkew(const StereoRig& rig, const StereoDepthResult& stereo,
                     const ApproachAngleResult::Motion& step) {
  GroundPlane plane = stereo.plane;
  const std::optional<PlaneVector> seen = PlaneVector::of(plane.g);
  if (stereo.skew == 0 || !seen) return plane;
  const double q = meanInverseDepth(rig, stereo);
  const auto add = [&](const Eigen::Vector3d& velocity, const Eigen::Vector3d& angular_velocity) {
    const Eigen::Vector3d error = planeErrorOfSkew(rig, *seen, q, {velocity, angular_velocity}, stereo.skew);
    plane.covariance += error * error.transpose();
  };
  if (!step.failure && step.duration > 0) {
    const double speed_scale = plane.height() / step.duration;
    // The step's rotation is that of the scene in the camera, opposite to the camera's.
    add(speed_scale * step.translation_over_height, -step.rotation / step.duration);
  } else {
    add(aircraft::kSpeed * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero());
    add(aircraft::kSideways * Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero());
    for (int axis = 0; axis < 3; ++axis)
      add(Eigen::Vector3d::Zero(), aircraft::kTurnRateWithinPair * Eigen::Vector3d::Unit(axis));
  }
  return plane;
}

BaselineDirection baselineOfSkew(const StereoRig& rig, const StereoDepthResult& stereo,
                                 const ApproachAngleResult::Motion& step) {
  constexpr double kShare = 0.2;  // 1 sigma, of the way
  const double over_baseline = stereo.skew / rig.baseline;
  BaselineDirection direction{Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()};
  if (stereo.skew == 0) return direction;
  if (!step.failure && step.duration > 0) {
    const double speed_scale = stereo.plane.height() / step.duration;
    direction.t = over_baseline * speed_scale * step.translation_over_height.tail<2>();
    direction.covariance = std::pow(kShare, 2) * direction.t.squaredNorm() * Eigen::Matrix2d::Identity();
  } else {
    direction.covariance.diagonal() << std::pow(over_baseline * aircraft::kSideways, 2),
        std::pow(over_baseline * aircraft::kSpeed, 2);
  }
  return direction;
}

}  // namespace uav_landing
