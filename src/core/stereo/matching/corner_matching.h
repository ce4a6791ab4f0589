#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "base/image_memory.h"
#include "image/corners.h"
#include "results/disparity_sample.h"
#include "stereo/matching/row_refinement.h"
#include "stereo/matching/stereo_level.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// Memory that corners on the ground are looked for in.
struct GroundCornerMemory {
  CornerMemory corners;
  ImageMemory ground;
};

/// Harris corners of the left image below the horizon of the plane g (1/m), where it predicts a disparity.
std::vector<cv::Point> findGroundCorners(const StereoLevel& level, const Eigen::Vector3d& g, int count,
                                         const StereoDepthParameters& parameters, GroundCornerMemory& memory);
/// The same with memory of its own.
std::vector<cv::Point> findGroundCorners(const StereoLevel& level, const Eigen::Vector3d& g, int count,
                                         const StereoDepthParameters& parameters);

/// Those of the corners that are so on another plane.
std::vector<cv::Point> cornersOnGround(const StereoLevel& level, const std::vector<cv::Point>& corners,
                                       const Eigen::Vector3d& g);

/// Corners that were found along their rows, in the order in which they were looked for.
struct RowMatches {
  std::vector<DisparitySample> samples;
  /// For each sample, where it is when its row may move as well; none where that was not looked for, as
  /// vertical disparities are measured by some of the corners only.
  std::vector<std::optional<RowRefinement::Across>> across;
};

/// Vertical disparities are measured by so many corners, spread as these are: enough, as the filter behind
/// averages over frames.
constexpr size_t kCornersAcross = 240;

/// Matches corners along their rows around the disparity that g predicts: gain and offset free
/// correlation (or SSD), uniqueness, left-right check, sub-pixel. One disparity a sample.
RowMatches matchCorners(const StereoLevel& level, const std::vector<cv::Point>& corners,
                        const Eigen::Vector3d& g, const StereoDepthParameters& parameters);

/// How far from the predicted place a corner is looked for.
struct CornerReach {
  int steps = 0;           ///< columns that are scored to both sides
  size_t most_across = 0;  ///< corners that are looked for across their rows, too, spread as the corners are
};
/// The same within this reach.
RowMatches matchCorners(const StereoLevel& level, const std::vector<cv::Point>& corners,
                        const Eigen::Vector3d& g, const StereoDepthParameters& parameters,
                        const CornerReach& reach);

}  // namespace uav_landing
