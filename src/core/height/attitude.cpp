#include "height/attitude.h"

#include <cmath>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

/// a - b, in -pi .. pi.
double angleDifference(double a, double b) { return std::remainder(a - b, 2 * M_PI); }

/// First-order variance of yawOf(), by central differences in both directions.
double yawVariance(const GroundNormal& ground, const GroundDirection& landing) {
  const Eigen::Vector3d &normal = ground.vector(), &direction = landing.vector();
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
  return (by_normal * ground.covariance() * by_normal.transpose()).value() +
         (by_direction * landing.covariance() * by_direction.transpose()).value();
}

}  // namespace

void reportAttitude(const std::optional<GroundNormal>& normal,
                    const std::optional<GroundDirection>& landing_direction, LandingResult& result) {
  if (!normal) return;
  result.pitch = pitchOf(normal->vector());
  result.pitch_variance = pitchVariance(normal->vector(), normal->covariance());
  result.roll = rollOf(normal->vector());
  result.roll_variance = rollVariance(normal->vector(), normal->covariance());
  if (!landing_direction) return;
  result.yaw = yawOf(normal->vector(), landing_direction->vector());
  result.yaw_variance = yawVariance(*normal, *landing_direction);
}

}  // namespace uav_landing
