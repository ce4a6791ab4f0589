#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace uav_landing {

/// The stamps of one topic, in the order of the bag, sorted by the clock that they belong to.
struct StampEpochs {
  std::vector<int> epoch;      ///< of each message, from 0 on: one more after each time that the clock was
                               ///< set back
  std::vector<bool> repeated;  ///< it has the stamp of an earlier message of its epoch
  std::vector<bool>
      late;       ///< it came among existing stamps, and its clock is unknown, so its stamp cannot be trusted
  int jumps = 0;  ///< times that the clock was set back
};

/// Sorts stamps by clock. A message that comes after newer ones is late when it fills a gap between earlier
/// stamps. A clock that was set back gives stamps among existing ones, and so does a recording of a loop.
/// stamps: ns, 0 is none. max_late: s, of RectifyParameters.
StampEpochs stampEpochs(const std::vector<int64_t>& stamps, double max_late);

}  // namespace uav_landing
