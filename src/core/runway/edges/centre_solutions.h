#pragma once

#include <vector>

#include "runway/edges/runway_fit.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The runway's width by a chart.
struct ChartWidth {
  double width = 0;       ///< in multiples of the height; 0: unknown
  bool rivalled = false;  ///< other edges than those of this width have a symmetry of their own
};

/// Centre line without each of its sources, in multiples of the height.
///
/// A wrong source moves the centre line away from the solution without it. So the distance to that solution
/// bounds the error, as in solution_separation.h.
/// - Without an edge, the other paint tells the centre. Where there is none, the other edge and half of the
///   known width do.
/// - Half of a runway has no stripe in its middle, and not the known width. Where one of them is seen, the
///   runway is whole. A width says nothing where other edges are about as symmetric.
///
/// pairs, outermost: see fitRunway(). whole: the centre by all pairs.
CentreSolutions centreSolutions(const GroundAxes& axes, const std::vector<MirroredEdges>& pairs,
                                size_t outermost, const CentreSolutions::Solution& whole,
                                const ChartWidth& chart);

}  // namespace uav_landing
