#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// The mask (mono8), but 0 wherever a u + b v + c < 0 at the pixel (u, v). kept: takes it; may be the mask.
/// All of it is 0 when a coefficient is not finite.
void keepHalfPlane(const cv::Mat& mask, double a, double b, double c, cv::Mat& kept);

}  // namespace uav_landing
