#pragma once

#include <Eigen/Core>
#include <vector>

#include "lines/segments/line_segment.h"
#include "runway/direction/runway_object.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// The hypothesis with the largest lead. lead: by how much that exceeds the lead of any other direction, and
/// of two lines that meet by chance. margin: by how much the evidence for this direction exceeds that for any
/// other. It comes from this pair alone, so margins of several pairs may be averaged. Where the path is known
/// it is limited, the less the more bars are seen (mostOfMargin()).
struct RunwayChoice {
  RunwayHypothesis best;
  double margin, lead;
};

/// Finds the runway among the lines of one view.
///
/// Streets, roofs, fields and shores are parallel lines, too, and together they often outweigh a runway. So
/// the search compares objects and not directions. An object is two edges of opposite contrast that vanish at
/// one point of the ground's horizon.
///
/// Evidence for an object:
/// - The lines along both edges and between them point clearly to that vanishing point.
/// - Much of both edges is seen.
/// - The object is long for its width.
/// - Few lines run elsewhere between the edges.
///
/// Evidence against it:
/// - Many more lines beside it have the same direction, as streets and crop rows come in rows.
/// - It is longer than the chart says, or of another width.
/// - Its direction is off the horizon, or far from the flight path or from the previous pair's direction.
/// - The flight path passes it at the side, or is far above where it begins.
///
/// The penalties for direction, path and size are limited, so that enough evidence of lines outweighs what
/// was known before.
///
/// lines: of the view, fitted. K: 3x3 of the view. Fails with no_runway when no two lines may be such edges.
Expected<RunwayChoice> findRunwayHypothesis(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                            const ApproachAngleParameters& parameters,
                                            const RunwayPrior& prior);

}  // namespace uav_landing
