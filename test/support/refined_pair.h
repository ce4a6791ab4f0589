#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/plane_limits.h"
#include "stereo/photometric/direct_refinement.h"
#include "support/ground_pair.h"

namespace uav_landing {
namespace test {

inline PlaneLimits groundLimits() {
  PlaneLimits limits;
  limits.max_roll = limits.max_pitch = 30 * kDegree;
  limits.min_points = 20;
  return limits;
}

/// Textured ground whose plane is found by direct refinement.
struct RefinedPair : GroundPair {
  explicit RefinedPair(unsigned seed = 5, double roll = 3) : GroundPair({320, 240}, seed, 4, -8, roll) {}

  Expected<PlaneFit> refine(const PlaneVector& start) const {
    return DirectRefinement(model, 4).refine(left, right, {start, rows}, groundLimits(), 0);
  }
  /// Largest error of the disparity over the ground's part of the image, pixels.
  double error(const Eigen::Vector3d& g) const {
    double largest = 0;
    for (const int v : {120, 239}) {
      for (const int u : {0, 319}) {
        largest = std::max(largest, std::abs(rig.fb() * (g - truth.vector()).dot(rig.ray(u, v))));
      }
    }
    return largest;
  }
  double rollError(const Expected<PlaneFit>& fit) const {
    return rollOf(fit->plane.normal()) - rollOf(truth.normal());
  }
};

}  // namespace test
}  // namespace uav_landing
