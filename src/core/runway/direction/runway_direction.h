#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "base/image_memory.h"
#include "lines/segments/line_segments.h"
#include "lines/vanishing/vanishing_point.h"
#include "runway/direction/seen_ground.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Lines and vanishing point of the runway in both rectified views, and both views' direction combined.
struct RunwayDirection {
  ApproachAngleResult::View left, right;
  /// Those of the views, with their uncertainty; where a runway is followed, those that may lie along it.
  std::vector<LineSegment> left_lines, right_lines;
  Expected<VanishingPoint> combined = tl::make_unexpected(Failure{Reason::kNotYet, ""});
};

/// Memory that it is looked for in.
struct RunwayDirectionMemory {
  LineMemory lines;
  ImageMemory ground;
};

/// Stages 3 and 4. ground: from stereo, or null; with it lines are looked for below the horizon only, the
/// direction must lie near the ground, and where a view has too few lines for a vanishing point of its own,
/// two long edges side by side that agree in both views are enough. Where the ground has a runway already,
/// only lines that may be along it are fitted, and if the left view's point is on the ground and not there by
/// chance, its lines are looked for in the right view where the ground has them, instead of all lines there.
/// Masks: of the rectified views, eroded. rows: lines are those at the stamp, but for the views' reports.
RunwayDirection findRunwayDirection(const StereoRig& rig, const cv::Mat& left, const cv::Mat& right,
                                    const cv::Mat& left_mask, const cv::Mat& right_mask,
                                    const SeenGround* ground, const ApproachAngleParameters& parameters,
                                    RunwayDirectionMemory& memory, Timings& timings,
                                    const ViewRows& rows = {});

}  // namespace uav_landing
