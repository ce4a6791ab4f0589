#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "lines/segments/line_segment.h"

namespace uav_landing {

/// Corrects lines for the effect of blur on the two sides of a narrow stripe, as the vanishing point needs
/// it. Blur of sigma s pushes the gradient peaks of a stripe narrower than about 3 s apart. A stripe of no
/// width has its peaks at +-s from its middle, at any distance. So a painted line's side that is followed
/// into the distance misses its vanishing point by s, on the dark side.
/// The middle between the two sides has no such error, by symmetry. Neither have stations at which the sides
/// are far enough apart. Such a line is replaced by the better of these two; other lines stay as they are.
/// image, ground: as for findLines(). The result has the same number of lines in the same order. Two lines
/// that became the middle of one stripe share its information.
std::vector<LineSegment> withoutStripeBias(const cv::Mat& image, const cv::Mat& ground,
                                           const std::vector<LineSegment>& lines);

}  // namespace uav_landing
