#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// What lines are refined in.
struct EdgePicture {
  cv::Mat image, transposed;  ///< mono8; transposed has the image's columns as rows
  cv::Mat ground;             ///< mono8, of the image: edges only where it is not 0
};

}  // namespace uav_landing
