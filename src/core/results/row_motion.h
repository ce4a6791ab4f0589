#pragma once

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// 1 sigma of an approach angle about which nothing is known, rad.
constexpr double kAnyAngle = 1;

/// Whether rows that move on their own (vibration) move the angle by more than its variance covers. Such a
/// motion tells no angle.
inline bool rowsMove(const ApproachAngleResult::Motion& motion) {
  return motion.row_motion > motion.row_motion_limit;
}

}  // namespace uav_landing
