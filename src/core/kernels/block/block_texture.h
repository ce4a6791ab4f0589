#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>

#include "kernels/block/block_sums.h"

namespace uav_landing {

constexpr int kBlockPixels = kBlockWidth * kBlockHeight;

/// Factor of Sobel's 3 x 3 kernel over a derivative.
constexpr float kSobelScale = 8.f;

/// Sum of the squares of a block's derivatives along the row minus their mean, by Sobel's kernel, not scaled.
/// first: the block's first pixel, of a mono8 image. stride: from row to row. One pixel on all sides of the
/// block must exist.
int slopeEnergy(const uchar* first, std::ptrdiff_t stride);

/// Grey levels of a block and its slopes, which are the derivatives along the row by Sobel's kernel, each
/// without its mean. Then sums over the pixels of their products.
struct BlockTexture {
  float grey_energy, slope_energy, both;  ///< grey^2, slope^2, grey slope
  float moment_u, moment_v;               ///< slope^2 times the column and the row, from the first pixel on
  float along_grey, along_slope;  ///< exact derivative (of fourth order) along the row times grey, slope
  float down_grey, down_slope;    ///< the same of the derivative down the column
  std::array<float, kBlockPixels> grey, slope;  ///< row by row
};

/// Measures the block whose first pixel is (u, v), in a mono8 image with two more pixels on all sides of it.
void measureTexture(const cv::Mat& image, int u, int v, BlockTexture& texture);

}  // namespace uav_landing
