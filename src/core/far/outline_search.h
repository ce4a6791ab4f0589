#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "far/outline.h"

namespace uav_landing {

/// Something in the image that may be the outline of a runway.
struct OutlineCandidate {
  Corners corners;      ///< to a pixel or two
  double strength = 0;  ///< grey levels over the parts of its sides that show
};

/// Looks for strips that get narrower upwards, darker or brighter than the ground on both sides: pairs of
/// opposite upright edges in bands of some rows, which go on from band to band. The texture of the ground is
/// drawn out across the image from afar, and has no upright edges. region: where to look. The strongest
/// ones, none of them within another.
std::vector<OutlineCandidate> searchOutlines(const cv::Mat& image, const cv::Mat& mask,
                                             const cv::Rect& region);

}  // namespace uav_landing
