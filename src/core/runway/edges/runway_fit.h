#pragma once

#include <vector>

#include "runway/direction/ground_edges.h"
#include "runway/edges/runway_cross_section.h"

namespace uav_landing {

/// Two edges on opposite sides of the centre line, at the same distance from it.
struct MirroredEdges {
  const GroundEdge *left, *right;
};

/// Centre line, direction and width of the runway by least squares over the pieces of all its edges in both
/// views. Each edge has its own lateral position, and all have one direction. The axes' forward is one more
/// measurement of that direction. Blur moves both sides of a pair, so it is an unknown, too. Marks are not
/// painted exactly, so the middles of the pairs scatter around the centre line. With several pairs, the fit
/// estimates that scatter.
/// outermost: index of the pair that is the runway's own edges.
RunwayCrossSection fitRunway(const GroundAxes& axes, const std::vector<MirroredEdges>& pairs,
                             size_t outermost);

}  // namespace uav_landing
