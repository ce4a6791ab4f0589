#pragma once

#include "integrity/vanishing_memory.h"
#include "landing/pair_input.h"

namespace uav_landing {

/// The runway's direction that a pair sees. One that leaps is of other lines, as of the edge of a shadow, and
/// the one before takes its place; but for two pairs at most, as the turn that it is compared by may have
/// been wrong.
class Heading {
 public:
  /// normal: of the ground, unit.
  VanishingMemory::Direction follow(const PairInput& in, const Eigen::Vector3d& normal);

 private:
  VanishingMemory memory_;
  int held_ = 0;  // pairs in a row
};

}  // namespace uav_landing
