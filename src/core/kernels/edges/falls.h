#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Pixels to both sides of the middle that are looked at.
constexpr int kFallReach = 12;
/// Pixels to both sides of the middle that are read.
constexpr int kFallMargin = kFallReach + 2;

/// Where grey levels fall most. middle: of a row of pixels; the fall at pixel k is what the pixel before is
/// brighter than the one behind, or the other way round where sign is -1. Bit k + kFallReach is set where the
/// fall is at least least and not smaller than at the two neighbours, for |k| <= kFallReach. least: 0 to 255.
unsigned markFalls(const uchar* middle, int sign, int least);

}  // namespace uav_landing
