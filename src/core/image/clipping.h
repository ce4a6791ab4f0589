#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace uav_landing {

/// The window around a place of a smoothed image (MatchImage::fine) has something in it that is brighter than
/// the camera could see. Lines of one or two pixels may be missed: smoothed, they are not white.
bool isClipped(const cv::Mat& image, const Eigen::Vector2d& centre, int radius);

}  // namespace uav_landing
