#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/stereo/row_warp.h"

namespace uav_landing {

/// Sub-pixel position by Gauss-Newton over (position, gain, offset): reference = gain other(warp) + offset.
struct RowRefinement {
  bool converged = false;
  double position = 0;
  double stddev = 0;  ///< 1 sigma of the position from residuals and gradient, pixels
  double score = 0;   ///< correlation after refinement
};

/// Of the window around (u, v) of the reference, from this column of the other image on. Both images CV_32F
/// of the same size. Not converged where the window leaves an image, has no contrast along the row, or is not
/// found within 1.5 px.
RowRefinement refineAlongRow(const cv::Mat& reference, const cv::Mat& other, int u, int v, double position,
                             const RowWarp& warp, int radius);

}  // namespace uav_landing
