#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"
#include "uav_landing/stereo/plane_consensus.h"

namespace uav_landing {

/// Both rectified images at one resolution with the rig and masks that belong to it.
struct StereoLevel {
  StereoRig rig;
  cv::Mat left_mask, right_mask;  ///< mono8, already eroded by the matching window
  cv::Mat left, right;            ///< CV_32F, smoothed
};

/// Rig and masks at a resolution reduced by an integer factor; the masks are eroded by margin pixels there.
StereoLevel reduceLevel(const RigModel& model, int factor, int margin);

/// The same pair with left and right exchanged (to tell a swapped rig from a featureless one).
StereoLevel swapped(const StereoLevel& level);

/// Harris corners of the left image below the horizon of the plane g (1/m), where it predicts a disparity.
std::vector<cv::Point> findGroundCorners(const StereoLevel& level, const Eigen::Vector3d& g, int count,
                                         const StereoDepthParameters& parameters);

/// Those of the corners that are so on another plane.
std::vector<cv::Point> cornersOnGround(const StereoLevel& level, const std::vector<cv::Point>& corners,
                                       const Eigen::Vector3d& g);

/// Stage 8: matches corners along their rows around the disparity that g predicts: gain and offset free
/// correlation (or SSD), uniqueness, left-right check, sub-pixel. One disparity a sample.
std::vector<DisparitySample> matchCorners(const StereoLevel& level, const std::vector<cv::Point>& corners,
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
