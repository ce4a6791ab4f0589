#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// The images in which lines are refined.
struct EdgePicture {
  cv::Mat image, transposed;  ///< mono8; transposed has the image's columns as rows
  cv::Mat ground;             ///< mono8, as large as the image; edges count only where it is not 0
};

}  // namespace uav_landing
