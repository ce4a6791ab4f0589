#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "base/image_memory.h"
#include "image/input/rectified_view.h"
#include "lines/segments/line_segments.h"
#include "lines/vanishing/vanishing_point.h"
#include "runway/direction/seen_ground.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Lines and vanishing points of the runway in both rectified views, and the direction combined from both.
struct RunwayDirection {
  ApproachAngleResult::View left, right;
  /// Lines of the views with their uncertainty. While a runway is followed, only those that may lie along it.
  std::vector<LineSegment> left_lines, right_lines;
  Expected<VanishingPoint> combined = tl::make_unexpected(Failure{Reason::kNotYet, ""});
};

/// Both rectified images of a pair. The masks are eroded.
struct StereoViews {
  const StereoRig& rig;
  RectifiedView left, right;
};

/// Working memory of the search.
struct RunwayDirectionMemory {
  LineMemory lines;
  ImageMemory ground;
};

/// Finds the direction of the runway in both views (stages 3 and 4).
///
/// With known ground, lines are searched for below the horizon only, and the direction must lie near the
/// ground. A view may have too few lines for a vanishing point of its own. Then two long edges side by side
/// that agree in both views are enough.
///
/// While a runway is followed on that ground, only lines that may run along it are fitted. If the left view's
/// vanishing point is certain and on the ground, the right view is searched only where the ground puts the
/// left view's lines.
///
/// left_lines and right_lines are as they would be with all rows exposed at the stamp. The reports `left` and
/// `right` show lines as they are in the images. ground: from stereo, or null.
RunwayDirection findRunwayDirection(const StereoViews& views, const SeenGround* ground,
                                    const ApproachAngleParameters& parameters, RunwayDirectionMemory& memory,
                                    Timings& timings);

}  // namespace uav_landing
