#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Where in the raw picture the lens shows what the pixels of a rectified picture look at, px.
struct RawPlaces {
  cv::Mat x, y;  ///< CV_32FC1
};
/// c: of the delivered image, checked. projection, size: of the rectified picture, by P or at another scale.
RawPlaces rawPlaces(const CameraCalibration& c, const Eigen::Matrix3d& projection, cv::Size size);

}  // namespace uav_landing
