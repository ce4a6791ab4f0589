#pragma once

namespace uav_landing {

/// A parameter that an earlier version had elsewhere.
struct MovedParameter {
  const char *was, *now;  ///< section/name
};

constexpr MovedParameter kMovedParameters[] = {
    {"approach_angle/runway_width", "runway/width"},
    {"kalman_height/known_runway_width", "runway/width"},
};

}  // namespace uav_landing
