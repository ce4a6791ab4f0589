#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "uav_landing/parameters/runway_parameters.h"

namespace uav_landing {

/// Widths that runways have, m: from one in a laboratory to one of an airport.
constexpr double kNarrowestRunway = 0.4, kWidestRunway = 90;

/// Largest accepted chance that a reported direction belongs to something else.
constexpr double kLargestDoubt = 1e-3;
/// The same where edges along the direction tell a place. They have to agree over some pairs besides.
constexpr double kLargestDoubtOfEdges = 0.01;

/// Two edges side by side on the ground that may be a runway's, with what lies between them.
struct RunwayHypothesis {
  /// Vanishing direction of the edges, unit, frame of the view.
  Eigen::Vector3d direction = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double left = 0, right = 0;  ///< lateral places of the edges, in heights of the camera, left positive
  double near = 0, far = 0;    ///< ends of the part where both are seen, forward, in heights
  double evidence = 0;         ///< log-likelihood ratio to a pair of lines that is there by chance
  double marks = 0;            ///< part of it from marks between the edges, little for those that roads have
  double lead = 0;             ///< evidence, less the penalty for a turn since the previous pair
  /// Per line: 1 for the edges, and for lines along the runway between them.
  std::vector<char> members;

  double width() const { return left - right; }
};

/// Knowledge about the runway's direction before the lines are seen, in the frame of the view.
struct RunwayPrior {
  Eigen::Vector3d normal;               ///< of the ground, unit, pointing down
  Eigen::Matrix3d normal_covariance;    ///< contains the runway's own slope against the ground, rad^2
  std::optional<double> height;         ///< of the camera above the ground, m
  std::optional<Eigen::Vector3d> path;  ///< direction of flight, unit
  std::optional<Eigen::Vector3d> last;  ///< direction of the runway in the previous pair, unit
  RunwayParameters runway = {};         ///< data of the chart; used when the height is known
  double last_doubt = 0;                ///< chance that `last` belonged to something else
};

}  // namespace uav_landing
