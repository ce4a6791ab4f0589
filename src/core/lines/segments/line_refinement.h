#pragma once

#include <Eigen/Core>
#include <optional>

#include "lines/segments/edge_picture.h"
#include "lines/segments/line_segment.h"

namespace uav_landing {

/// Fits a straight line to the peak of the intensity gradient along a rough segment (off by up to 2 px), to
/// sub-pixel. At each row (column, when the line is flat) the peak near the line is interpolated. Only
/// gradients with the sign of the rough segment count, so the two sides of a thin stripe do not mix. The line
/// grows or shrinks to the ends of the edge.
/// The standard deviations come from the scatter of the peaks about the line. The line's normal (l0, l1)
/// points to the brighter side. min_gradient: weakest peak, grey/px. Returns nothing when there is no edge or
/// when it is not straight.
std::optional<LineSegment> refineLine(const EdgePicture& picture, const RoughSegment& rough,
                                      double min_gradient);

/// Unit vector across a rough segment towards its brighter side, like the normal of a refined line.
Eigen::Vector2d brighterSide(const EdgePicture& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

}  // namespace uav_landing
