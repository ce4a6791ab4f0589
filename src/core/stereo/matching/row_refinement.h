#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "image/windows/reference_window.h"
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

/// Place of a reference's window in the same row of another image.
struct RowPlace {
  double column;  ///< of the window's middle
  RowWarp warp;
};

/// Refines the place of the reference's window in the other image, from `start` on. Both images are CV_32F of
/// the same size. Not converged when the window leaves an image, has no contrast along the row, or moves by
/// more than 1.5 px. across_too: fill `across`, too.
RowRefinement refineAlongRow(const cv::Mat& reference, const cv::Mat& other, const SquareWindow& window,
                             const RowPlace& start, bool across_too = false);

}  // namespace uav_landing
