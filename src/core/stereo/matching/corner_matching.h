#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "base/image_memory.h"
#include "geometry/plane_vector.h"
#include "image/windows/corners.h"
#include "results/disparity_sample.h"
#include "stereo/matching/row_refinement.h"
#include "stereo/matching/stereo_level.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// Memory that the search for corners on the ground works in. Its contents mean nothing.
struct GroundCornerMemory {
  CornerMemory corners;
  ImageMemory ground;
};

/// Harris corners of the left image below the horizon of the plane g (1/m), where g predicts a disparity.
std::vector<cv::Point> findGroundCorners(const StereoLevel& level, const PlaneVector& g, int count,
                                         const StereoDepthParameters& parameters, GroundCornerMemory& memory);
/// The same with memory of its own.
std::vector<cv::Point> findGroundCorners(const StereoLevel& level, const PlaneVector& g, int count,
                                         const StereoDepthParameters& parameters);

/// Those of the corners that lie on the ground of another plane g (1/m).
std::vector<cv::Point> cornersOnGround(const StereoLevel& level, const std::vector<cv::Point>& corners,
                                       const PlaneVector& g);

/// Corners that were found along their rows, in the order in which they were looked for.
struct RowMatches {
  std::vector<DisparitySample> samples;
  /// Place of each sample when its row may move as well. It is empty for most samples, as vertical
  /// disparities need only some of the corners.
  std::vector<std::optional<RowRefinement::Across>> across;
};

/// Number of corners that measure vertical disparities, spread as all corners are. They are enough because a
/// filter averages over the pairs.
constexpr size_t kCornersAcross = 240;

/// Matches corners along their rows around the disparity that g (1/m) predicts. It uses correlation that is
/// blind to gain and offset (or SSD), a uniqueness test, a left-right check and a sub-pixel fit. One
/// disparity per sample.
RowMatches matchCorners(const StereoLevel& level, const std::vector<cv::Point>& corners, const PlaneVector& g,
                        const StereoDepthParameters& parameters);

/// How far from the predicted place a corner is looked for.
struct CornerReach {
  int steps = 0;           ///< columns scored on each side
  size_t most_across = 0;  ///< corners that may also leave their rows, at most; spread as all corners are
};
/// The same within this reach.
RowMatches matchCorners(const StereoLevel& level, const std::vector<cv::Point>& corners, const PlaneVector& g,
                        const StereoDepthParameters& parameters, const CornerReach& reach);

}  // namespace uav_landing
