#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace uav_landing {

/// The stamps of one topic, in the order of the bag, told apart by the clock that they are of.
struct StampEpochs {
  std::vector<int> epoch;      ///< of each message, from 0 on: one more each time that the clock was set back
  std::vector<bool> repeated;  ///< has the stamp of an earlier message of its epoch
  std::vector<bool>
      late;       ///< came among stamps that were there, and of no clock: its stamp is not to be trusted
  int jumps = 0;  ///< times that the clock was set back
};

/// A message that comes after newer ones is late where it fills a gap between the stamps before it. A clock
/// that was set back gives stamps among those that were there already; so does a recording of a loop.
/// stamps: ns, 0 is none. max_late: s, of RectifyParameters.
StampEpochs stampEpochs(const std::vector<int64_t>& stamps, double max_late);

}  // namespace uav_landing
