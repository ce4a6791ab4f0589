#include "geometry/plane_limits.h"

#include <cmath>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

bool isPlausibleGround(const PlaneVector& g, const PlaneLimits& limits) {
  const Eigen::Vector3d n = g.normal();
  return n.y() > 0 && std::abs(pitchOf(n)) <= limits.max_pitch && std::abs(rollOf(n)) <= limits.max_roll;
}

}  // namespace uav_landing
