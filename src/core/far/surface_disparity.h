#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "far/outline.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The disparity of a surface where it holds.
struct SurfaceDisparity {
  Eigen::Vector2d pixel;  ///< in the left image, px
  double value = 0;       ///< px
  double variance = 0;    ///< by the noise of the images alone, px^2
};

/// Both rectified images of a pair, and how the right one's rows lie against the left one's.
struct SightedPair {
  const cv::Mat &left, &right;            ///< mono8
  const cv::Mat &left_mask, &right_mask;  ///< mono8, 255 where a pixel is usable
  RigRotation rows;                       ///< by vertical disparities; not known: rows are level
};

/// Measures the disparity of the surface within an outline by aligning the grey levels of both images, in one
/// least squares over all pixels, with a common gain and offset. The long edges of a runway tell it to a
/// hundredth of a pixel, so stereo sees a runway of 45 m to some per cent from 1 km. The plane before the
/// threshold says less of the runway than that, as the ground may rise or fall.
///
/// corners: of the surface in the left image. about: plane of the surface, known roughly. Its slope is taken
/// from there, and only its distance is measured. Nothing where the images do not look alike.
std::optional<SurfaceDisparity> measureDisparity(const SightedPair& pair, const Corners& corners,
                                                 const GroundPlane& about, const StereoRig& rig);

}  // namespace uav_landing
