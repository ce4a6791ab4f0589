#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "lines/line_segment.h"

namespace uav_landing {

/// Lines as the vanishing point needs them: free of what blur does to the two sides of a narrow stripe. Blur
/// of sigma s pushes the gradient's peaks at the sides of a stripe that is narrower than some 3 s away from
/// each other, to +-s from the middle for a stripe of no width, however far away it is. So a side of a
/// painted line that is followed into the distance passes its vanishing point by s, on the dark side. The
/// middle between the two sides has no such error, by symmetry, and neither have the stations where they are
/// far enough apart: such a line is replaced by the better of the two. Others stay as they are. image,
/// ground: as for findLines(). The result has the same number of lines in the same order; two that are the
/// middle of one stripe share its information.
std::vector<LineSegment> withoutStripeBias(const cv::Mat& image, const cv::Mat& ground,
                                           const std::vector<LineSegment>& lines);

}  // namespace uav_landing
