#pragma once

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// 1 sigma of an approach angle about which nothing is known, rad.
constexpr double kAnyAngle = 1;

}  // namespace uav_landing
