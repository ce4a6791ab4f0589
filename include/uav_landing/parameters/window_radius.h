#pragma once

namespace uav_landing {

/// Matching windows are (2 r + 1) squared; the largest r for which there is memory, pixels.
constexpr int kLargestWindowRadius = 15;

}  // namespace uav_landing
