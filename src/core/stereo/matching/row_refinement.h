#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "image/windows/patch_refinement.h"
#include "stereo/matching/row_warp.h"

namespace uav_landing {

/// Sub-pixel position by Gauss-Newton over (position, gain, offset): reference = gain other(warp) + offset.
struct RowRefinement {
  bool converged = false;
  double position = 0;
  double stddev = 0;  ///< 1 sigma of the position from residuals and gradient, pixels
  double score = 0;   ///< correlation after refinement

  /// Place when the window may also leave its row, within two pixels of the place along the row.
  struct Across {
    Across() = default;
    explicit Across(const PatchRefinement& refined);

    bool found = false;
    Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< in the other image, pixels
    double column_variance = 0, row_variance = 0;     ///< pixels^2
    double score = 0;                                 ///< correlation there
  } across;
};

/// Refines the window around (u, v) of the reference, from column `position` of the other image on. Both
/// images are CV_32F of the same size. Not converged when the window leaves an image, has no contrast along
/// the row, or moves by more than 1.5 px. across_too: fill `across`, too.
RowRefinement refineAlongRow(const cv::Mat& reference, const cv::Mat& other, int u, int v, double position,
                             const RowWarp& warp, int radius, bool across_too = false);

}  // namespace uav_landing
