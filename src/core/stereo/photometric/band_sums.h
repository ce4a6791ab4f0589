#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "kernels/block/block_sums.h"

namespace uav_landing {

/// Blocks of kBlockWidth by kBlockHeight pixels, side by side.
struct BlockGrid {
  int columns = 0, lines = 0;
  int first_row = 4;       ///< even
  std::vector<char> seen;  ///< for each, line by line, whether both cameras see all of it

  size_t at(int column, int line) const { return static_cast<size_t>(line) * columns + column; }
};
/// Pixels beside a grid, and at least above and below it, for derivatives. Even.
constexpr int kGridColumn = 4, kGridRow = 4;

/// Sums over the pixels of a block of one band: of what the aligned images (their means are zero) have in
/// common, and of the left one's derivative along the row, the slope, per pixel of the whole images.
struct BandSums {
  float count = 0;                          ///< pixels
  float left = 0, right = 0, products = 0;  ///< left^2, right^2, left right
  float slope_left = 0, slope_right = 0;    ///< slope left, slope right
  float slopes = 0, down = 0;               ///< slope^2, slope (derivative down the column)
  float signal = 0;  ///< slope (right one's derivative): slopes without the noise, which is not in common

  void add(const BandSums& other);
};

/// Of the blocks that are seen, others have a count of 0. left, right: CV_32F, reduced by factor.
void addUp(const cv::Mat& left, const cv::Mat& right, int factor, const BlockGrid& grid,
           std::vector<BandSums>& sums);

/// The same of each block with its up to eight neighbours.
void addNeighbours(const BlockGrid& grid, const std::vector<BandSums>& sums, std::vector<BandSums>& around);

}  // namespace uav_landing
