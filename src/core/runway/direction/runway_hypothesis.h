#pragma once

#include <Eigen/Core>
#include <vector>

#include "lines/segments/line_segment.h"
#include "runway/direction/runway_object.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// The hypothesis with the largest lead. margin, lead: by how much its evidence and its lead exceed those of
/// any in another direction, and those of two lines that are there by chance. The margin is of this pair
/// alone: that of several pairs may be averaged. It has a limit for an object without marks (mostOfMargin()).
struct RunwayChoice {
  RunwayHypothesis best;
  double margin, lead;
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
/// and so does an object that the path passes by, up to a limit: enough evidence of lines outweighs what was
/// believed.
///
/// lines: of the view, fitted. K: 3x3 of the view. Fails when no two lines may be such edges.
Expected<RunwayChoice> findRunwayHypothesis(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                            const ApproachAngleParameters& parameters,
                                            const RunwayPrior& prior);

}  // namespace uav_landing
