#include "far/disparity_bias.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace uav_landing {
namespace {

constexpr double kMemory = 5;  // s after which a rig may have changed by what a calibration leaves
// Errors of planes and normals are alike in so many pairs in a row.
constexpr double kAlike = 10;

}  // namespace

void DisparityBias::predict(double stamp, double calibrated) {
  const double T = stamp - std::exchange(stamp_, stamp), most = calibrated * calibrated;
  if (!(T >= 0) || calibrated != calibrated_) {
    calibrated_ = calibrated;
    value_ = 0;
    variance_ = most;
  } else {
    variance_ = std::min(variance_ + most * T / kMemory, most);
  }
}

void DisparityBias::update(const GroundPlane& plane, const ApproachAngleResult::Motion& motion) {
  const double most = calibrated_ * calibrated_;
  const Eigen::Vector3d& n = motion.normal;
  if (!(most > 0) || !plane.valid() || motion.failure || !n.allFinite() || !(n.y() > 0)) return;
  // The bias is that change of g_z which tilts the plane by as much as the motion says.
  const double across = plane.g.head<2>().norm();
  const double seen = rig_.fb() * (plane.g.z() - across * n.z() / n.head<2>().norm());
  const double of_plane = std::max(rig_.fb() * rig_.fb() * plane.covariance(2, 2) - most, 0.0);
  const double of_motion = std::pow(rig_.fb() * across, 2) * pitchVariance(n, motion.normal_covariance);
  const double noise = kAlike * (of_plane + of_motion);
  if (!std::isfinite(seen + noise) || !(noise > 0)) return;
  const double gain = variance_ / (variance_ + noise);
  value_ += gain * (seen - value_);
  variance_ *= 1 - gain;
}

GroundPlane DisparityBias::corrected(GroundPlane plane) const {
  if (!plane.valid()) return plane;
  const double scale = rig_.fb() * rig_.fb();
  const double noise = std::max(plane.covariance(2, 2) - calibrated_ * calibrated_ / scale, 0.0);
  plane.g.z() -= value_ / rig_.fb();
  plane.covariance(2, 2) = std::max(noise + variance_ / scale, 1e-3 * plane.covariance(2, 2));
  return plane;
}

}  // namespace uav_landing
