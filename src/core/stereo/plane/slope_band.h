#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/plane_limits.h"
#include "results/disparity_sample.h"
#include "stereo/matching/stereo_level.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// Planes whose disparity changes by nearly the same amount from row to row. Windows with one shear match on
/// all of them.
struct SlopeBand {
  double shear;           ///< disparity per row, pixels
  Eigen::Vector2d range;  ///< of the planes, in the same unit
};

/// Overlapping bands. A level camera sees a slope of baseline over height, so the last band serves heights
/// down to a third of the baseline. The first kFar bands have small disparities.
struct SlopeBands {
  static constexpr size_t kAll = 10, kFar = 5;
  static SlopeBand at(size_t index);
};

/// Copies an image so that windows have room beside it. Places in that room get no score.
void addRoomBeside(const cv::Mat& image, cv::Mat& wide);

/// Both images at one size, with room beside the right one.
struct RoomyLevel {
  StereoLevel level;
  cv::Mat right;  ///< of the level, by addRoomBeside()
};

/// Corners with all places along their rows that look like them.
struct BandCandidates {
  std::vector<DisparitySample> samples;
  int scored = 0;  ///< number of places
};

/// Looks for corners on the planes of a band that are within the limits.
BandCandidates candidatesOf(const SlopeBand& band, const RoomyLevel& images,
                            const std::vector<cv::Point>& corners, const StereoDepthParameters& parameters,
                            const PlaneLimits& limits);

}  // namespace uav_landing
