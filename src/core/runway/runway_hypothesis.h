#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lines/line_segment.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/runway_parameters.h"

namespace uav_landing {

/// Widths that runways have, m: from a laboratory's to an airport's.
constexpr double kNarrowestRunway = 0.4, kWidestRunway = 90;

/// Two edges side by side on the ground that may be those of a runway, with what lies between them.
struct RunwayHypothesis {
  Eigen::Vector3d direction;  ///< in which the edges vanish, unit, frame of the view
  double left, right;         ///< places of the edges across it, in heights of the camera, left positive
  double near, far;           ///< from where to where both are seen, forward, in heights
  double evidence;            ///< log of the likelihood ratio to a pair of lines that is there by chance
  double lead;                ///< the same with what speaks for the direction in the pair before
  std::vector<char> members;  ///< per line: 1 for the edges and for what runs along the runway between them

  double width() const { return left - right; }
};

/// The hypothesis with the largest lead. margin, lead: by how much its evidence and its lead exceed those of
/// any in another direction, and those of two lines that are there by chance. The margin is of this pair
/// alone: that of several pairs may be averaged.
struct RunwayChoice {
  RunwayHypothesis best;
  double margin, lead;
};

/// What is known of the runway's direction before lines are looked at, frame of the view.
struct RunwayPrior {
  Eigen::Vector3d normal;               ///< of the ground, unit, pointing down
  Eigen::Matrix3d normal_covariance;    ///< with the runway's own slope against that ground, rad^2
  std::optional<double> height;         ///< of the camera above the ground, m
  std::optional<Eigen::Vector3d> path;  ///< direction of flight, unit
  std::optional<Eigen::Vector3d> last;  ///< direction of the runway in the pair before, unit
  double max_yaw;                       ///< largest angle between runway and optical axis, rad
  RunwayParameters runway = {};         ///< what charts say of it; used where the height is known
};

/// The runway among the lines of one view.
///
/// Streets, roofs, fields and shores are parallel lines, too, and together they often outweigh a runway. So
/// the search compares objects and not directions. An object is two edges with opposite contrast that vanish
/// at one point of the ground's horizon. Its evidence is how surely the lines along both edges and between
/// them point there, how much of both edges is seen, how long it is for its width, and how few lines run
/// elsewhere between the edges. Many more lines beside it in its direction are evidence against it: streets
/// and crop rows come in rows. An object of another width than the chart's, or longer, loses evidence. A
/// direction off the horizon, or far from the path or from the direction in the pair before, costs evidence,
/// up to a limit: enough evidence of lines outweighs what was believed.
///
/// lines: of the view, fitted. K: 3x3 of the view. Fails when no two lines may be such edges.
Expected<RunwayChoice> findRunwayHypothesis(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                            const RunwayPrior& prior, double tolerance);

}  // namespace uav_landing
