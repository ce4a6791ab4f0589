#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereo/matching/corner_matching.h"
#include "stereo/plane/plane_fit.h"

namespace uav_landing {

/// What the corners of a pair say.
struct MatchedCorners {
  std::vector<cv::Point> corners;  ///< that were looked for
  RowMatches matches;
  PlaneFit fit;  ///< the plane of most of them, where there is one
};

/// The plane that most disparities of corners agree on, fitted to these. corners: that were looked for.
/// expected: the plane that they were looked for by. bias_stddev: as for refinePlane. Fails when there are
/// too few, or no plane.
Expected<PlaneFit> fitCorners(const StereoRig& rig, const std::vector<DisparitySample>& samples, int corners,
                              const Eigen::Vector3d& expected, const PlaneLimits& limits, double bias_stddev);

/// What the covariance of that plane leaves out, 1/m^2: noise of pixels that several windows are of, and
/// errors that are alike in a part of the image (image_cells.h), in the directions in which they move the
/// plane. window: width and height of the corners' windows, pixels.
Eigen::Matrix3d sharedCovariance(const StereoRig& rig, const MatchedCorners& corners, int window,
                                 double bias_stddev);

}  // namespace uav_landing
