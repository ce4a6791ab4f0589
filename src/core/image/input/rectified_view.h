#pragma once

#include <opencv2/core.hpp>

#include "geometry/stamp_map.h"

namespace uav_landing {

/// The rectified image of one camera.
struct RectifiedView {
  const cv::Mat& image;  ///< mono8
  const cv::Mat& mask;   ///< mono8, 255 where the image is used
  StampMap rows = {};    ///< row times of the image; by default all rows are exposed at the stamp
};

}  // namespace uav_landing
