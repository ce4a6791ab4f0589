#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/plane_limits.h"
#include "geometry/plane_vector.h"
#include "results/disparity_sample.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// A plane and the number of samples that agree with it.
struct Consensus {
  PlaneVector g;
  double support;  ///< about the number of agreeing samples
  double score;    ///< support less penalties; ranks the planes
};

/// How a consensus is looked for.
struct ConsensusOptions {
  int iterations = 0;  ///< plausible planes drawn, at most
  /// Ends early when a better plane would most likely have been drawn already.
  bool until_sure = false;
  /// Bounds of the change of disparity per row, for the planes drawn. The least squares that follow may leave
  /// them. Most planes are out of bounds, so each is drawn through two samples, which is quick.
  std::optional<Eigen::Vector2d> slope_range{};
  /// A plane that is tried first and improved. If it gets four fifths of the votes, nothing is drawn: a
  /// different plane would have fewer.
  std::optional<PlaneVector> expected{};
  /// Draws per plausible plane, at most. Implausible planes cost next to nothing.
  int draws_each = 20;
};

/// Plane by consensus (MSAC over triples and pairs; fixed seed): the plausible plane with the most support. A
/// sample that matches nearer than the plane stands above the ground and costs little. A sample that matches
/// farther would lie below the ground, which is impossible, so it counts against the plane. Nothing when no
/// plane drawn is plausible.
std::optional<Consensus> findPlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                                   const PlaneLimits& limits, const ConsensusOptions& options);

}  // namespace uav_landing
