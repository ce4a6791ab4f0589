#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "stereo/matching/stereo_level.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// A plane with how well each corner correlates where it says.
struct RivalPlane {
  Eigen::Vector3d g;                ///< 1/m
  std::vector<double> correlation;  ///< below 0 where the place is outside the right image

  RivalPlane(const StereoLevel& level, const std::vector<cv::Point>& corners, const Eigen::Vector3d& plane,
             const StereoDepthParameters& parameters);

  /// Whether the corners that match on both planes match better on this one. Only repeated texture matches on
  /// two. Where much of it is outside the other view on the right plane, the one that is a bar off may have
  /// more votes, but it does not look quite the same. A sign test over at least so many, so that a few
  /// corners do not decide.
  bool matchesBetterThan(const RivalPlane& other, int least) const;
};

}  // namespace uav_landing
