#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "lines/segment_scanner.h"
#include "uav_landing/lines/line_segments.h"

namespace uav_landing {

/// What lines are refined in.
struct EdgePicture {
  cv::Mat image, transposed;  ///< mono8; transposed has the image's columns as rows
  cv::Mat ground;             ///< mono8, of the image: edges only where it is not 0
};

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

/// Line through two points with these standard deviations, the normal 90 degrees clockwise (in the picture)
/// of the direction from a to b.
LineSegment makeLineSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double offset_stddev,
                            double angle_stddev);

}  // namespace uav_landing
