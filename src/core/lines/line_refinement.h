#pragma once

#include <Eigen/Core>
#include <optional>

#include "lines/edge_picture.h"
#include "lines/line_segment.h"

namespace uav_landing {

/// Fits a straight line to the intensity gradient's peak along a rough segment (off by up to 2 px), to
/// sub-pixel: at rows (columns, when the line is flat) the gradient's peak near the line is interpolated.
/// Only gradients of the rough segment's sign count, so the two sides of a thin stripe do not mix. The line
/// grows or shrinks to where the edge is. The standard deviations come from the scatter of the peaks about
/// the line. The line's normal (l0, l1) points to the brighter side. min_gradient: weakest peak, grey/px.
/// Nothing is returned when the edge is not there or not straight.
std::optional<LineSegment> refineLine(const EdgePicture& picture, const RoughSegment& rough,
                                      double min_gradient);

/// Unit vector across a rough segment towards its brighter side, as a refined line's normal would be.
Eigen::Vector2d brighterSide(const EdgePicture& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

}  // namespace uav_landing
