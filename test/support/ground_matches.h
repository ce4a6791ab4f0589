#pragma once

#include <cmath>
#include <vector>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {
namespace test {

/// Matches on a grid over the ground of the plane g.
inline std::vector<StereoDepthResult::Point> matchesOn(const StereoRig& rig, const Eigen::Vector3d& g) {
  std::vector<StereoDepthResult::Point> points;
  for (int v = 300; v < 470; v += 12) {
    for (int u = 20; u < 620; u += 25) {
      const double error = 0.05 * std::sin(1.7 * u + 2.9 * v);
      points.push_back({double(u), double(v), rig.fb() * g.dot(rig.ray(u, v)) + error, 0.05, true});
    }
  }
  return points;
}

}  // namespace test
}  // namespace uav_landing
