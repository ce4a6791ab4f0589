#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "runway/direction/ground_edges.h"
#include "runway/position/runway_cross_section.h"
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

/// What is known of the runway's width, multiples of the height.
struct RunwayWidth {
  double known = 0;                                         ///< 0: not known
  double widest = std::numeric_limits<double>::infinity();  ///< shores and fields are wider

  RunwayWidth(double width = 0, double limit = std::numeric_limits<double>::infinity())  // NOLINT: a number
      : known(width), widest(limit) {}
};

/// The runway's edges.
///
/// A runway is painted symmetrically. Each edge on its left has a counterpart on the right whose brighter
/// side is the other one. The centre line is where most length of edges agrees on that, long edges among
/// them. The runway's own edges are the outermost long ones. Sometimes one more long edge lies as far beyond
/// one side of a pair, and none beyond the other. Then the pair is an edge and the centre line, and nothing
/// is found unless the width is known.
///
/// edges: of the ground along the runway.
/// expected: from frames before. Without it a symmetry is believed only if no other one with long edges comes
/// near it, and if it is more than that of any two lines. One of these has to hold:
/// - a stripe is in the middle;
/// - marks besides the edges share it;
/// - the edges are two unbroken lines alike;
/// - they are two lines with room beyond either, and the outlook shows no third one there;
/// - the only pair is a dark strip that begins within the picture or has the known width.
Expected<RunwayCrossSection> findRunwayEdges(const GroundAxes& axes, const std::vector<GroundEdge>& edges,
                                             const RunwayWidth& width,
                                             const std::optional<ExpectedCentre>& expected,
                                             const Outlook* outlook = nullptr);

}  // namespace uav_landing
