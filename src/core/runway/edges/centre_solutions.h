#pragma once

#include <vector>

#include "runway/edges/runway_fit.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Centre line without each of its sources, in multiples of the height.
///
/// A wrong source moves the centre line away from the solution without it. So the distance to that solution
/// bounds the error, as in solution_separation.h.
/// - Without an edge, the other paint tells the centre. Where there is none, the other edge and half of the
///   known width do.
/// - Half of a runway has no stripe in its middle, and not the known width. Where one of them is seen, the
///   runway is whole. A width says nothing where other edges are about as symmetric.
///
/// pairs, outermost: see fitRunway(). known_width: by a chart, in multiples of the height; 0: unknown.
/// rivalled: whether other edges have a symmetry of their own.
CentreSolutions centreSolutions(const GroundAxes& axes, const std::vector<MirroredEdges>& pairs,
                                size_t outermost, double known_width, bool rivalled);

}  // namespace uav_landing
