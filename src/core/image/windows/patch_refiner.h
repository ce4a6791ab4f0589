#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "image/windows/patch_refinement.h"
#include "image/windows/reference_window.h"

namespace uav_landing {

/// Refines the place of a window by Gauss-Newton over (shift, gain, offset), with the reference's own
/// gradient. own: of this very window.
PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                            const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius,
                            OwnTexture& own);
inline PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                                   const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius) {
  OwnTexture own;
  return refinePatch(reference, other, u, v, position, warp, radius, own);
}

/// Refines from `position` on, as refinePatch() does. first: solution of a look at that position, if there
/// was one; or null. distances: as for evidence(); without them only the covariance is available.
PatchRefinement refineWindow(const ReferenceWindow& window, const cv::Mat& other,
                             const Eigen::Vector2d& position, const Eigen::Matrix2d& warp,
                             const GainShift* first, bool distances);

}  // namespace uav_landing
