#pragma once

namespace uav_landing {

/// From so much time between two pairs on, s, the later one is seen for itself. What was found in the earlier
/// one is too far off to lead on, and there is time to search within one pair.
constexpr double kRarePairs = 0.3;

}  // namespace uav_landing
