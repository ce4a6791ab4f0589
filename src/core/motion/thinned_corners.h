#pragma once

#include <vector>

#include "uav_landing/motion/temporal_matching.h"

namespace uav_landing {

/// At most count of the corners, spread as the corners are.
inline std::vector<TrackedCorner> thinned(const std::vector<TrackedCorner>& corners, size_t count) {
  if (corners.size() <= count) return corners;
  std::vector<TrackedCorner> some;
  for (size_t i = 0; i < count; ++i) some.push_back(corners[i * corners.size() / count]);
  return some;
}

}  // namespace uav_landing
