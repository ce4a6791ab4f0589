#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Places in the raw image from which the pixels of a rectified image come, px.
struct RawPlaces {
  cv::Mat x, y;  ///< CV_32FC1
};
/// c: of the delivered image, already checked. projection, size: of the rectified image, by P or at another
/// scale.
RawPlaces rawPlaces(const CameraCalibration& c, const Eigen::Matrix3d& projection, cv::Size size);

}  // namespace uav_landing
