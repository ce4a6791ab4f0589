#pragma once

namespace uav_landing {

/// Matching windows are (2 r + 1) squared; the largest r for which there is memory, pixels.
constexpr int kLargestWindowRadius = 15;
/// The default, for which loops over windows are unrolled.
constexpr int kUsualWindowRadius = 5;

}  // namespace uav_landing
