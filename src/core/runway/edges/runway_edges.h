#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "runway/direction/ground_edges.h"
#include "runway/edges/pair_evidence.h"
#include "runway/edges/runway_cross_section.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Expected place of the centre line, and its largest distance from there, in multiples of the height.
struct ExpectedCentre {
  double centre = 0, tolerance = 0;
};

/// Knowledge about the runway's width, in multiples of the height.
struct RunwayWidth {
  double known = 0;  ///< width by a chart; 0: unknown
  /// Upper limit, as shores and fields are farther apart.
  double widest = std::numeric_limits<double>::infinity();

  RunwayWidth(double width = 0, double limit = std::numeric_limits<double>::infinity())  // NOLINT: a number
      : known(width), widest(limit) {}
};

/// Centre line and width of two lines, in multiples of the height.
struct LinePair {
  double centre = 0, variance = 0, width = 0;
};

/// Why there is no runway.
struct EdgeRefusal : Failure {
  std::optional<LinePair> half;  ///< lines that would be it, but are half of a wider one
};

using FoundRunway = tl::expected<RunwayCrossSection, EdgeRefusal>;

/// Finds the runway's edges and measures its cross section.
///
/// A runway is painted symmetrically. Each edge on its left has a counterpart on the right whose brighter
/// side is the other one. The centre line is the one on which the largest length of edges agrees, with long
/// edges among them. The runway's own edges are the outermost long ones. A pair may also be an edge and the
/// centre line of a wider runway. Then one more long edge lies beyond one side of the pair, at the distance
/// of the pair's width, and none beyond the other side. In that case nothing is found unless the width is
/// known.
///
/// edges: along the runway on the ground. expected: from earlier pairs. outlook: or null.
///
/// Without an expected centre, a symmetry must also be clearly better than any other one with long edges. If
/// the width is unknown, it must be more than two lines with a middle as well. Any of these shows that:
/// - A narrow bright stripe lies in the middle.
/// - Several marks or long edges besides the outermost pair share the symmetry.
/// - The edges are two unbroken lines that look alike, each with both of its sides.
/// - They are two painted lines, and the outlook shows free ground where a third one would be.
/// - The outermost pair is a dark strip that begins within the image.
FoundRunway findRunwayEdges(const GroundAxes& axes, const std::vector<GroundEdge>& edges,
                            const RunwayWidth& width, const std::optional<ExpectedCentre>& expected,
                            const Outlook* outlook = nullptr);

}  // namespace uav_landing
