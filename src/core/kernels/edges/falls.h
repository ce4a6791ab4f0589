#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Pixels on each side of the middle that are tested.
constexpr int kFallReach = 12;
/// Pixels on each side of the middle that are read.
constexpr int kFallMargin = kFallReach + 2;

/// Where grey levels fall most. The fall at pixel k is the pixel before minus the one behind, or the reverse
/// when sign is -1. Bit k + kFallReach is set when the fall is at least least and not smaller than at both
/// neighbours, for |k| <= kFallReach. middle: pixel of a row. least: 0 to 255.
unsigned markFalls(const uchar* middle, int sign, int least);

}  // namespace uav_landing
