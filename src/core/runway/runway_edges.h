#pragma once

#include <optional>
#include <vector>

#include "runway/ground_edges.h"
#include "runway/runway_cross_section.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Where the centre line is expected, and by how much it may differ.
struct ExpectedCentre {
  double centre = 0, tolerance = 0;
};

/// What is seen of the ground beside the runway, so that the lack of an edge says something, too.
struct Outlook {
  const StereoRig& rig;
  const std::vector<GroundEdge>& edges;  ///< seen by at least one view
};

/// The runway's edges. A runway is painted symmetrically, so that each edge on its left has a counterpart on
/// the right whose brighter side is the other one; the centre line is where most length of edges agrees on
/// that, and where long edges do: the runway's own edges are the outermost long ones. A pair with one more
/// long edge as far beyond one of its sides, and none beyond the other, is an edge and the centre line:
/// unless the runway's width is known, nothing is found then. edges: of the ground along the runway. width:
/// what the runway is known to measure, multiples of the height; 0 when not known. expected: from frames
/// before; without it, a symmetry is believed only if no other one with long edges comes near it, and if it
/// is not that of any two lines: a stripe is in the middle, or marks besides the edges share it, or the edges
/// are two unbroken lines alike, or two lines with room beyond either where the outlook shows no third one,
/// or the only pair is a dark strip that begins within the picture or has the known width.
Expected<RunwayCrossSection> findRunwayEdges(const GroundAxes& axes, const std::vector<GroundEdge>& edges,
                                             double width, const std::optional<ExpectedCentre>& expected,
                                             const Outlook* outlook = nullptr);

}  // namespace uav_landing
