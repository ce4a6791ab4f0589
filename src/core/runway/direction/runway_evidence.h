#pragma once

#include <optional>

#include "runway/direction/line_pencil.h"
#include "runway/direction/runway_object.h"

namespace uav_landing {

/// What speaks for and against an object that may be a runway: log-likelihood ratios to two lines that are
/// there by chance. A pencil is that of the object's direction.

/// The object with these two places of its edges: from where to where both are seen, its members, and its
/// evidence by its lines. Nothing when the edges are not seen side by side.
std::optional<RunwayHypothesis> runwayBetween(const GroundLines& lines, const LinePencil& pencil, double left,
                                              double right);

/// Against a direction off the ground's horizon.
double againstHorizon(const Eigen::Vector3d& direction, const RunwayPrior& prior);
/// Against an object that the path of flight does not lead along, or to the side of which it passes.
double againstPath(const RunwayHypothesis& object, const RunwayPrior& prior);
/// The largest margin that an object may have: a road or a canal may lead along the path as well, but has no
/// marks. Infinite while no path is known.
double mostOfMargin(const RunwayHypothesis& object, const RunwayPrior& prior);
/// Against a direction other than that of the pair before, as far as that was the runway's.
double againstTurn(const Eigen::Vector3d& direction, const RunwayPrior& prior);
/// Against an object whose size is not the chart's.
double againstSize(const RunwayHypothesis& object, const RunwayPrior& prior);

/// Angle of a direction on the ground, left of the optical axis, rad.
double azimuthOn(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction);

}  // namespace uav_landing
