#pragma once

#include <optional>

#include "runway/direction/line_pencil.h"
#include "runway/direction/runway_object.h"

namespace uav_landing {

/// Evidence for and against an object that may be a runway. All values are log-likelihood ratios to two lines
/// that are there by chance. A pencil belongs to the direction of the object.

/// The object between two edges at these lateral places. It gets its near and far end, its members, and the
/// evidence of its lines. Nothing when the edges are not seen side by side.
std::optional<RunwayHypothesis> runwayBetween(const GroundLines& lines, const LinePencil& pencil, double left,
                                              double right);

/// Penalty for a direction that is not on the ground's horizon.
double againstHorizon(const Eigen::Vector3d& direction, const RunwayPrior& prior);
/// Penalty for an object that the flight path does not lead along, passes at the side, or is far above where
/// it begins.
double againstPath(const RunwayHypothesis& object, const RunwayPrior& prior);
/// Largest margin that an object may have. A road or a canal may lead along the flight path as well, but it
/// has no bars. Infinite while no path is known.
double mostOfMargin(const RunwayHypothesis& object, const RunwayPrior& prior);
/// Penalty for a direction that differs from the previous pair's one. It is limited by the chance that the
/// previous one was wrong.
double againstTurn(const Eigen::Vector3d& direction, const RunwayPrior& prior);
/// Penalty for an object whose size differs from the chart's.
double againstSize(const RunwayHypothesis& object, const RunwayPrior& prior);

/// Angle of a direction on the ground to the left of the optical axis, rad.
double azimuthOn(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction);

}  // namespace uav_landing
