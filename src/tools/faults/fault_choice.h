#pragma once

#include <string>
#include <vector>

#include "faults/faults.h"

namespace uav_landing {

/// Faults that come together, in the order of their places.
using FaultCombination = std::vector<const Fault*>;

/// Names with + between.
std::string nameOf(const FaultCombination& faults);

/// Whether it paints on a plane: on ground of another shape that would be a picture of that plane, and not of
/// the ground that the height is above.
bool paintsGround(const Fault* fault);

/// Which faults are flown.
class FaultChoice {
 public:
  /// names: of faults, and pairs as a+b; without any all faults. drawn_pairs: of faults besides, for each
  /// seed. Faults that need a scene only where it is simulated. Throws std::runtime_error for what names no
  /// fault or pair.
  FaultChoice(const std::vector<std::string>& names, int drawn_pairs, bool simulated);
  /// Each fault alone, the pairs asked for, and some pairs drawn by the seed.
  std::vector<FaultCombination> combinations(uint64_t seed) const;

 private:
  void addPair(const std::string& names, bool simulated);

  int drawn_pairs_;
  std::vector<const Fault*> faults_;
  std::vector<FaultCombination> asked_pairs_;
};

}  // namespace uav_landing
