#pragma once

#include "integrity/vanishing_memory.h"
#include "landing/pair_input.h"
#include "landing/pair_monitor.h"

namespace uav_landing {

/// The runway's direction that a pair sees. If it leaps (for example, to the edge of a shadow), the one
/// before is kept for two pairs at most: the turn that the two are compared by may have been wrong.
class Heading {
 public:
  /// normal: of the ground, unit.
  VanishingMemory::Direction follow(const PairInput& in, const Eigen::Vector3d& normal);

 private:
  VanishingMemory memory_;
  int held_ = 0;  // pairs in a row
};

/// Why the direction that the pair sees is not to be taken for the runway's; none where it may be. pair: what
/// the tests say of it.
Failure yawFailure(const PairInput& in, const PairVerdict& pair);

}  // namespace uav_landing
