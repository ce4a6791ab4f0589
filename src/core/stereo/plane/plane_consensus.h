#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/plane_limits.h"
#include "results/disparity_sample.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// A plane and who agrees with it.
struct Consensus {
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  double support = 0;  ///< about the number of agreeing samples
  double score = 0;    ///< support less the penalties: what planes are ranked by
  bool found = false;
};

/// How a consensus is looked for.
struct ConsensusOptions {
  int iterations = 0;  ///< plausible planes drawn, at most
  /// Ends when a better plane would have been drawn already.
  bool until_sure = false;
  /// Bounds on the change of disparity per row of the planes drawn. The least squares that follow may leave
  /// them. Most planes that are drawn have another one, so they are drawn through pairs, which is quick.
  std::optional<Eigen::Vector2d> slope_range{};
  /// A plane that is tried first. Nothing is drawn when four fifths of the votes are for what it is improved
  /// to, as a quite different one would have less.
  std::optional<Eigen::Vector3d> expected{};
  /// Draws for each plausible plane, at most. Implausible ones cost next to nothing.
  int draws_each = 20;
};

/// Plane by consensus (MSAC over triples and pairs; fixed seed): the plausible plane with the most support. A
/// pixel that matches nearer than the plane stands above the ground and costs nothing; one that matches
/// farther would lie below it, which ground does not allow, and counts against the plane.
Consensus findPlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                    const PlaneLimits& limits, const ConsensusOptions& options);

}  // namespace uav_landing
