#include "landing/heading.h"

#include <Eigen/Geometry>

namespace uav_landing {

VanishingMemory::Direction Heading::follow(const PairInput& in, const Eigen::Vector3d& normal) {
  constexpr int kMostHeld = 2;
  const VanishingMemory::Direction seen{in.approach.vanishing_direction, in.approach.vanishing_covariance};
  if (!in.repeated()) {  // else it is as it was
    const Eigen::Vector3d across = normal.cross(seen.direction).normalized();
    held_ = memory_.leaps(in.approach.stamp, seen, across, in.turn) ? held_ + 1 : 0;
    if (held_ > kMostHeld) {
      memory_.reset();
      held_ = 0;
    }
  }
  return held_ > 0 ? *memory_.remembered() : seen;
}

}  // namespace uav_landing
