#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "offline/processed_pair.h"

namespace uav_landing {

/// What went wrong with the pairs of a recording, counted.
struct PairTally {
  std::size_t pairs = 0, valid = 0;
  std::size_t alternating =
      0;                      ///< pairs that are uniform where the one before is not, or the other way round
  std::size_t repeating = 0;  ///< pairs whose left and right pictures both are those of the pair before
  std::map<std::string, std::size_t> reasons;       ///< of those that are not valid
  std::map<std::string, std::size_t> failed_tests;  ///< of all pairs

  void add(const ProcessedPair& pair);

 private:
  bool uniform_ = false;
};

/// The most likely cause, with what to do, where less than half of the pairs are valid; else "".
std::string verdictOf(const PairTally& tally);

}  // namespace uav_landing
