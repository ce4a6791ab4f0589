#include "landing/heading.h"

#include <Eigen/Geometry>

#include "base/text.h"

namespace uav_landing {
namespace {

// Chance at most that the direction is that of something else.
constexpr double kLargestDoubt = 1e-3;

}  // namespace

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

Failure yawFailure(const PairInput& in, const PairVerdict& pair) {
  const ApproachAngleResult& approach = in.approach;
  if (in.repeated()) return {Reason::kRejected, "the left image is that of the pair before"};
  if (pair.failure) return pair.failure;
  if (!approach.vanishing_direction.allFinite()) {
    if (approach.left.failure) return approach.left.failure;
    return {Reason::kNoVanishingPoint, "no direction of a runway"};
  }
  const double doubt = approach.other_runway_probability;
  if (doubt <= kLargestDoubt) return {};
  return {Reason::kNoRunway, text("the direction may be that of something else, with a probability of ",
                                  rounded(doubt), ", at most ", kLargestDoubt, " allowed")};
}

}  // namespace uav_landing
