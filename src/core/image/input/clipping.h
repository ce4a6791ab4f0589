#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Whether the window around a place of a smoothed image (MatchImage::fine) contains something brighter than
/// the camera could see. Lines of one or two pixels may be missed, because smoothed they are not white.
bool isClipped(const cv::Mat& image, const Eigen::Vector2d& centre, int radius);

}  // namespace uav_landing
