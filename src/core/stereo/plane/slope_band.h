#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/plane_limits.h"
#include "results/disparity_sample.h"
#include "stereo/matching/stereo_level.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// Planes whose disparity changes by about the same from row to row, so that windows sheared by that match on
/// all of them.
struct SlopeBand {
  double shear;           ///< pixels of disparity a row
  Eigen::Vector2d range;  ///< of the planes, likewise
};

/// Bands that overlap, from the far plane to the one that is as near as the baseline is long. The first
/// `far` ones have small disparities.
struct SlopeBands {
  static constexpr size_t kAll = 10, kFar = 5;
  static SlopeBand at(size_t index);
};

/// A picture beside which there is room for windows: no score there.
cv::Mat withRoomBeside(const cv::Mat& image);

/// Corners with all places along their rows that resemble them.
struct BandCandidates {
  std::vector<DisparitySample> samples;
  int scored = 0;  ///< places that were looked at
};

/// On planes of a band within the limits. right: the level's right image with room beside it.
BandCandidates candidatesOf(const SlopeBand& band, const StereoLevel& level, const cv::Mat& right,
                            const std::vector<cv::Point>& corners, const StereoDepthParameters& parameters,
                            const PlaneLimits& limits);

}  // namespace uav_landing
