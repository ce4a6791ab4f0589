#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "stereo/matching/corner_matching.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// Finds corners of the left image and their places in the right one, at full size. Everything behind it
/// takes its matches as they are: the plane, its covariance, the corners that are followed over time.
class CornerMatcher {
 public:
  virtual ~CornerMatcher() = default;

  /// At most count corners on the ground of the plane g (1/m), well spread.
  virtual std::vector<cv::Point> detect(const StereoLevel& level, const Eigen::Vector3d& g, int count) = 0;
  /// Disparities of those that are found near the one that g predicts, in pixels, each with the standard
  /// deviation that it has: the plane's covariance is made of these.
  virtual RowMatches match(const StereoLevel& level, const std::vector<cv::Point>& corners,
                           const Eigen::Vector3d& g) = 0;
};

/// Harris corners, matched along their rows (findGroundCorners(), matchCorners()).
std::unique_ptr<CornerMatcher> makeRowMatcher(const StereoDepthParameters& parameters);

}  // namespace uav_landing
