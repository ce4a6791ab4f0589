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

/// Bands that overlap. A level camera sees a slope of the baseline over the height, so the last band is for
/// heights down to a third of the baseline. The first kFar have small disparities.
struct SlopeBands {
  static constexpr size_t kAll = 10, kFar = 5;
  static SlopeBand at(size_t index);
};

/// Copies a picture to where windows have room beside it; there is no score there.
void addRoomBeside(const cv::Mat& image, cv::Mat& wide);

/// Corners with all places along their rows that resemble them.
struct BandCandidates {
  std::vector<DisparitySample> samples;
  int scored = 0;  ///< places that were looked at
};

/// Looks on the planes of a band that are within the limits. right: the level's right image with room beside
/// it.
BandCandidates candidatesOf(const SlopeBand& band, const StereoLevel& level, const cv::Mat& right,
                            const std::vector<cv::Point>& corners, const StereoDepthParameters& parameters,
                            const PlaneLimits& limits);

}  // namespace uav_landing
