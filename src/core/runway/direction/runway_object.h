#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "uav_landing/parameters/runway_parameters.h"

namespace uav_landing {

/// Widths that runways have, m: from a laboratory's to an airport's.
constexpr double kNarrowestRunway = 0.4, kWidestRunway = 90;

/// Chance at most that a direction is that of something else, if it is told.
constexpr double kLargestDoubt = 1e-3;

/// Two edges side by side on the ground that may be those of a runway, with what lies between them.
struct RunwayHypothesis {
  Eigen::Vector3d direction;  ///< in which the edges vanish, unit, frame of the view
  double left, right;         ///< places of the edges across it, in heights of the camera, left positive
  double near, far;           ///< from where to where both are seen, forward, in heights
  double evidence;            ///< log of the likelihood ratio to a pair of lines that is there by chance
  double marks = 0;           ///< part of it: what runs along the runway between the edges
  double lead;                ///< the same with what speaks for the direction in the pair before
  std::vector<char> members;  ///< per line: 1 for the edges and for what runs along the runway between them

  double width() const { return left - right; }
};

/// What is known of the runway's direction before lines are looked at, frame of the view.
struct RunwayPrior {
  Eigen::Vector3d normal;               ///< of the ground, unit, pointing down
  Eigen::Matrix3d normal_covariance;    ///< with the runway's own slope against that ground, rad^2
  std::optional<double> height;         ///< of the camera above the ground, m
  std::optional<Eigen::Vector3d> path;  ///< direction of flight, unit
  std::optional<Eigen::Vector3d> last;  ///< direction of the runway in the pair before, unit
  RunwayParameters runway = {};         ///< what charts say of it; used where the height is known
  double last_doubt = 0;                ///< chance that `last` was the direction of something else
};

}  // namespace uav_landing
