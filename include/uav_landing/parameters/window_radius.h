#pragma once

namespace uav_landing {

/// A matching window has (2 r + 1) squared pixels. This is the largest r for which there is memory, pixels.
constexpr int kLargestWindowRadius = 15;
/// The default radius. Loops over windows of this size are unrolled.
constexpr int kUsualWindowRadius = 5;

}  // namespace uav_landing
