#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/image_memory.h"
#include "image/input/rectified_view.h"
#include "lines/segments/heading_gate.h"
#include "lines/segments/line_segment.h"
#include "lines/segments/segment_scanner.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Memory that the search for lines works in. Its contents mean nothing.
struct LineMemory {
  SegmentScanner scanner;
  ImageMemory transposed;
};

/// Lines of the ground (paper, section 2). They are straight edges followed from scan lines, or found by a
/// Hough transform of the Canny edges (hough_method). Then each is fitted to the gradient along it.
/// Deterministic. Returns an empty list when there are none.
/// view: its mask is set where lines are looked for (already eroded); its row times are not used. gate: only
/// lines that pass it are fitted. The others follow in the list, as they were found, good to half a pixel.
/// Null: all lines are fitted.
std::vector<LineSegment> findLines(const RectifiedView& view, const ApproachAngleParameters& parameters,
                                   const HeadingGate* gate, LineMemory& memory);
/// The same with memory of its own.
std::vector<LineSegment> findLines(const RectifiedView& view, const ApproachAngleParameters& parameters,
                                   const HeadingGate* gate = nullptr);

/// Those of the expected lines that exist and pass the gate, fitted to the gradient as above. expected: off
/// by up to 2 px; they may reach beyond the image.
std::vector<LineSegment> findLinesNear(const RectifiedView& view, const std::vector<RoughSegment>& expected,
                                       const ApproachAngleParameters& parameters, const HeadingGate& gate,
                                       LineMemory& memory);

}  // namespace uav_landing
