#pragma once

#include <string>
#include <vector>

#include "faults/faults.h"

namespace uav_landing {

/// Faults that occur together, in the order of their places.
using FaultCombination = std::vector<const Fault*>;

/// Names joined by +.
std::string nameOf(const FaultCombination& faults);

/// Whether the fault paints on a plane. On ground of another shape the image would be that of this plane, and
/// not of the ground that the height refers to.
bool paintsGround(const Fault* fault);

/// Chooses the faults that are flown.
class FaultChoice {
 public:
  /// names: faults, and pairs as a+b; without names all faults. drawn_pairs: number of further random pairs
  /// for each seed. Faults that need a scene are taken only when it is simulated. Throws std::runtime_error
  /// for a name that is no fault or pair.
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
