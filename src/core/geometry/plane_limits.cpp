#include "geometry/plane_limits.h"

#include <cmath>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

bool isPlausibleGround(const Eigen::Vector3d& g, const PlaneLimits& limits) {
  if (!g.allFinite() || !(g.y() > 0)) return false;
  const Eigen::Vector3d n = g.normalized();
  return std::abs(pitchOf(n)) <= limits.max_pitch && std::abs(rollOf(n)) <= limits.max_roll;
}

}  // namespace uav_landing
