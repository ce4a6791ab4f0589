#include "landing/watch/yaw_failure.h"

#include "base/text.h"
#include "runway/direction/runway_object.h"

namespace uav_landing {

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
