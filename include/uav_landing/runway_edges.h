#pragma once

#include <optional>
#include <vector>

#include "uav_landing/failure.h"
#include "uav_landing/ground_edges.h"

namespace uav_landing {

/// Where the runway lies across. Multiples of the left camera's height; left of the camera is positive.
struct RunwayCrossSection {
  double centre = 0, variance = 0;       ///< centre line
  double width = 0, width_variance = 0;  ///< between the outermost long edges
};

/// Where the centre line is expected, and by how much it may differ.
struct ExpectedCentre {
  double centre = 0, tolerance = 0;
};

/// The runway's edges. A runway is painted symmetrically, so that each edge on its left has a counterpart on
/// the right whose brighter side is the other one; the centre line is where most length of edges agrees on
/// that. The runway's own edges are the outermost long ones. edges: of the ground along the runway. width:
/// what the runway is known to measure, multiples of the height; 0 when not known. expected: from frames
/// before; without it, a symmetry is believed only if at least two pairs of edges (one, when the width is
/// known) share it and no other one comes near it.
Expected<RunwayCrossSection> findRunwayEdges(const GroundAxes& axes, const std::vector<GroundEdge>& edges,
                                             double width, const std::optional<ExpectedCentre>& expected);

}  // namespace uav_landing
