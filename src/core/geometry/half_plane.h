#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace uav_landing {

/// The mask (mono8) with 0 wherever a u + b v + c < 0 at the pixel (u, v). kept: receives it; may be the mask
/// itself. It is all 0 when a coefficient is not finite.
void keepHalfPlane(const cv::Mat& mask, double a, double b, double c, cv::Mat& kept);

/// The mask with 0 above the horizon (K^-T n) and just below it, up to a hundredth of the image's height.
/// There, the far ends of objects on the ground merge with what stands behind them. K: 3x3 of the view.
/// normal: of the ground, frame of the view. kept: of the mask's size; receives the result.
void keepBelowHorizon(const cv::Mat& mask, const Eigen::Matrix3d& K, const Eigen::Vector3d& normal,
                      cv::Mat& kept);

}  // namespace uav_landing
