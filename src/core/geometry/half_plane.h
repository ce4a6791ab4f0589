#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace uav_landing {

/// The mask (mono8), but 0 wherever a u + b v + c < 0 at the pixel (u, v). kept: takes it; may be the mask.
/// All of it is 0 when a coefficient is not finite.
void keepHalfPlane(const cv::Mat& mask, double a, double b, double c, cv::Mat& kept);

/// The mask without what lies above the horizon (K^-T n), or less than a hundredth of the picture's height
/// below it: there the far end of everything on the ground merges with what stands behind it. K: 3x3 of the
/// view. normal: of the ground, frame of the view. kept: of the mask's size.
void keepBelowHorizon(const cv::Mat& mask, const Eigen::Matrix3d& K, const Eigen::Vector3d& normal,
                      cv::Mat& kept);

}  // namespace uav_landing
