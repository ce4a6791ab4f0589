#include "height/attitude.h"

#include <cmath>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

/// a - b, in -pi .. pi.
double angleDifference(double a, double b) { return std::remainder(a - b, 2 * M_PI); }

/// First-order variance of yawOf(), by central differences in both directions.
double yawVariance(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
                   const Eigen::Vector3d& direction, const Eigen::Matrix3d& direction_covariance) {
  constexpr double kStep = 1e-5;
  Eigen::RowVector3d by_normal, by_direction;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
    by_normal[i] = angleDifference(yawOf((normal + step).normalized(), direction),
                                   yawOf((normal - step).normalized(), direction));
    by_direction[i] = angleDifference(yawOf(normal, (direction + step).normalized()),
                                      yawOf(normal, (direction - step).normalized()));
  }
  by_normal /= 2 * kStep;
  by_direction /= 2 * kStep;
  return (by_normal * normal_covariance * by_normal.transpose()).value() +
         (by_direction * direction_covariance * by_direction.transpose()).value();
}

}  // namespace

void reportAttitude(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
                    const Eigen::Vector3d& landing_direction, const Eigen::Matrix3d& direction_covariance,
                    LandingResult& result) {
  if (!normal.allFinite()) return;
  result.pitch = pitchOf(normal);
  result.pitch_variance = pitchVariance(normal, normal_covariance);
  result.roll = rollOf(normal);
  result.roll_variance = rollVariance(normal, normal_covariance);
  if (!landing_direction.allFinite()) return;
  result.yaw = yawOf(normal, landing_direction);
  result.yaw_variance = yawVariance(normal, normal_covariance, landing_direction, direction_covariance);
}

}  // namespace uav_landing
