#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "offline/processed_pair.h"

namespace uav_landing {

/// Counts of what went wrong with the pairs of a recording.
struct PairTally {
  std::size_t pairs = 0, valid = 0;
  std::size_t alternating = 0;  ///< pairs that are uniform while the previous one is not, or the reverse
  std::size_t repeating = 0;    ///< pairs whose left and right images both equal those of the previous pair
  std::string uniform;          ///< what the last uniform pair says of its images
  std::map<std::string, std::size_t> reasons;       ///< of pairs that are not valid
  std::map<std::string, std::size_t> failed_tests;  ///< of all pairs

  void add(const ProcessedPair& pair);

 private:
  bool uniform_ = false;
};

/// The most likely cause, with what to do, when less than half of the pairs are valid; else "".
std::string verdictOf(const PairTally& tally);

}  // namespace uav_landing
