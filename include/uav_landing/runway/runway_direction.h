#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "uav_landing/base/timings.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/lines/line_segments.h"
#include "uav_landing/lines/vanishing_point.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Lines and vanishing point of the runway in both rectified views, and both views' direction combined.
struct RunwayDirection {
  ApproachAngleResult::View left, right;
  std::vector<LineSegment> left_lines, right_lines;  ///< those of the views, with their uncertainty
  Expected<VanishingPoint> combined = tl::make_unexpected(Failure{Reason::kNotYet, ""});
};

/// Stages 3 and 4. plane: of the ground from stereo, or null; with it lines are looked for below the horizon
/// only, the direction must lie near the ground, and where a view has too few lines for a vanishing point of
/// its own, two long edges side by side that agree in both views are enough. Masks: of the rectified views,
/// eroded.
RunwayDirection findRunwayDirection(const StereoRig& rig, const cv::Mat& left, const cv::Mat& right,
                                    const cv::Mat& left_mask, const cv::Mat& right_mask,
                                    const GroundPlane* plane, const ApproachAngleParameters& parameters,
                                    Timings& timings);

}  // namespace uav_landing
