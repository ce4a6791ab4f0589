#pragma once

namespace uav_landing {

/// With so much time between two pairs (s), the later one is treated on its own. What the earlier one showed
/// is too old to predict from, and there is time to search within one pair.
constexpr double kRarePairs = 0.3;

}  // namespace uav_landing
