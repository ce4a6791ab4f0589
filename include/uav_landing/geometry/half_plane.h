#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Clears the mask (mono8) wherever a u + b v + c < 0 at the pixel (u, v).
void keepHalfPlane(cv::Mat& mask, double a, double b, double c);

}  // namespace uav_landing
