#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "image/windows/patch_refinement.h"
#include "image/windows/reference_window.h"

namespace uav_landing {

/// Place of a reference's window in another image.
struct WindowPlace {
  Eigen::Vector2d position;  ///< of the window's middle
  Eigen::Matrix2d warp;      ///< from the reference to the other image
};

/// Refines the place of a window by Gauss-Newton over (shift, gain, offset), with the reference's own
/// gradient. It begins at `start` and keeps the warp. own: of this very window.
PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, const SquareWindow& window,
                            const WindowPlace& start, OwnTexture& own);
inline PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, const SquareWindow& window,
                                   const WindowPlace& start) {
  OwnTexture own;
  return refinePatch(reference, other, window, start, own);
}

/// Refines from `start` on, as refinePatch() does. first: solution of a look at that position, if there
/// was one; or null. distances: as for evidence(); without them only the covariance is available.
PatchRefinement refineWindow(const ReferenceWindow& window, const cv::Mat& other, const WindowPlace& start,
                             const GainShift* first, bool distances);

}  // namespace uav_landing
