#pragma once

#include <vector>

#include "runway/direction/ground_edges.h"
#include "runway/position/runway_cross_section.h"

namespace uav_landing {

/// Two edges on opposite sides of the centre line, as far from it.
struct MirroredEdges {
  const GroundEdge *left, *right;
};

/// Centre line, direction and width of the runway by least squares over the pieces of all its edges in both
/// views. Each edge has a lateral position of its own, all have one direction, which the axes' forward tells
/// as well, but for what blur does to both sides of a pair; the middles of the pairs differ from the centre
/// line by how exactly the marks are painted, which shows when there are several.
/// outermost: index of the pair that is the runway's own edges.
RunwayCrossSection fitRunway(const GroundAxes& axes, const std::vector<MirroredEdges>& pairs,
                             size_t outermost);

}  // namespace uav_landing
