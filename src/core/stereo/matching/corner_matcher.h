#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/plane_vector.h"
#include "stereo/matching/corner_matching.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// Finds corners of the left image and their places in the right one, at full size. All later steps take
/// these matches as they are: the plane, its covariance, and the corners that are followed over time.
class CornerMatcher {
 public:
  virtual ~CornerMatcher() = default;

  /// At most count corners on the ground plane g (1/m), well spread over the image.
  virtual std::vector<cv::Point> detect(const StereoLevel& level, const PlaneVector& g, int count) = 0;
  /// Disparities, in pixels, of the corners that are found near the disparity predicted by g. Each comes with
  /// its own standard deviation, from which the plane's covariance is made.
  virtual RowMatches match(const StereoLevel& level, const std::vector<cv::Point>& corners,
                           const PlaneVector& g) = 0;
};

/// Harris corners, matched along their rows by findGroundCorners() and matchCorners().
std::unique_ptr<CornerMatcher> makeRowMatcher(const StereoDepthParameters& parameters);

}  // namespace uav_landing
