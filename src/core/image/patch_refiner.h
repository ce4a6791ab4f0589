#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "image/patch_refinement.h"
#include "image/reference_window.h"

namespace uav_landing {

/// By Gauss-Newton over (shift, gain, offset), with the reference's own gradient. own: of this very window.
PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                            const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius,
                            OwnTexture& own);
inline PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                                   const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius) {
  OwnTexture own;
  return refinePatch(reference, other, u, v, position, warp, radius, own);
}

/// From a place on as refinePatch does it. first: what a look there found, when there was one already.
/// distances: as for evidence(); without them only the covariance may be asked for.
PatchRefinement refineWindow(const ReferenceWindow& window, const cv::Mat& other,
                             const Eigen::Vector2d& position, const Eigen::Matrix2d& warp,
                             const GainShift* first, bool distances);

}  // namespace uav_landing
