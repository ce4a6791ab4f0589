#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/plane_limits.h"
#include "results/disparity_sample.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Plane by consensus (MSAC over triples; fixed seed): the plausible plane with the most support. A pixel
/// that matches nearer than the plane stands above the ground and costs nothing; one that matches farther
/// would lie below it, which ground does not allow, and counts against the plane.
/// slope_range, when not null: bounds on the change of disparity per row of the planes drawn (the least
/// squares that follow may leave them).
/// until_sure: ends when a better plane, of samples with one disparity each, would have been drawn already.
/// expected, when not null: a plane that is tried first; nothing is drawn when four fifths of the votes are
/// for what it is improved to, as a quite different one would have less.
struct Consensus {
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  double support = 0;  ///< about the number of agreeing samples
  double score = 0;    ///< support less the penalties: what planes are ranked by
  bool found = false;
};
Consensus findPlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                    const PlaneLimits& limits, int iterations, const Eigen::Vector2d* slope_range,
                    bool until_sure = false, const Eigen::Vector3d* expected = nullptr);

}  // namespace uav_landing
