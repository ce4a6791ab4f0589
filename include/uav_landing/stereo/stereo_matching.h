#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "uav_landing/parameters/stereo_depth_parameters.h"
#include "uav_landing/stereo/plane_consensus.h"
#include "uav_landing/stereo/row_refinement.h"
#include "uav_landing/stereo/stereo_level.h"

namespace uav_landing {

/// Harris corners of the left image below the horizon of the plane g (1/m), where it predicts a disparity.
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

/// Plane near a predicted one: matches within search_radius, then consensus. Not found when too few agree.
Consensus trackPlane(const StereoLevel& level, const Eigen::Vector3d& predicted,
                     const StereoDepthParameters& parameters, const PlaneLimits& limits);

/// The same by a few of the corners found at full size, this factor larger than the level. Not found unless
/// most of them agree.
Consensus trackPlaneByScouts(const StereoLevel& level, const std::vector<cv::Point>& corners, int factor,
                             const Eigen::Vector3d& predicted, const StereoDepthParameters& parameters,
                             const PlaneLimits& limits);

/// Plane with nothing known: full disparity range, windows sheared as for a range of heights, all peaks kept
/// as candidates and resolved by consensus, so that repeated texture does not decide.
Consensus searchPlane(const StereoLevel& level, const StereoDepthParameters& parameters,
                      const PlaneLimits& limits);

}  // namespace uav_landing
