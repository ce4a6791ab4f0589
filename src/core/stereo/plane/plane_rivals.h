#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/plane_vector.h"
#include "stereo/matching/stereo_level.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// A plane, and how well each corner correlates at the place that it predicts.
struct RivalPlane {
  PlaneVector g;
  std::vector<double> correlation;  ///< below 0 when the place is outside the right image

  RivalPlane(const StereoLevel& level, const std::vector<cv::Point>& corners, const PlaneVector& plane,
             const StereoDepthParameters& parameters);

  /// Whether the corners that match on both planes match better on this one. Only repeated texture matches on
  /// two planes. The plane that is one period off may have more votes, as more of it may be inside the other
  /// view, but it looks less alike. This is a sign test over at least `least` corners, so that a few do not
  /// decide.
  bool matchesBetterThan(const RivalPlane& other, int least) const;
};

}  // namespace uav_landing
