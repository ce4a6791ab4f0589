#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/plane_vector.h"
#include "stereo/matching/corner_matching.h"
#include "stereo/plane/plane_fit.h"

namespace uav_landing {

/// The corners of a pair with their matches and their plane.
struct MatchedCorners {
  std::vector<cv::Point> corners;  ///< all that were looked for
  RowMatches matches;
  PlaneFit fit;  ///< the plane that most of them agree on, if there is one
};

/// Finds the plane that most disparities agree on, and fits it to these. corners: number that was looked for.
/// expected: the plane that predicted their places, 1/m. Fails when there are too few matches, or when they
/// have no common plane.
Expected<PlaneFit> fitCorners(const StereoRig& rig, const Disparities& disparities, int corners,
                              const PlaneVector& expected, const PlaneLimits& limits);

/// The part that the covariance of that plane leaves out, 1/m^2. It contains the noise of pixels that several
/// windows share. It also contains errors that are alike in a part of the image (image_cells.h). window:
/// width and height of the corners' windows, pixels. bias_stddev: as in Disparities.
Eigen::Matrix3d sharedCovariance(const StereoRig& rig, const MatchedCorners& corners, int window,
                                 double bias_stddev);

}  // namespace uav_landing
