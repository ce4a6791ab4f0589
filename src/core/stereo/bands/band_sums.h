#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "kernels/block/block_sums.h"
#include "kernels/block/pair_sums.h"

namespace uav_landing {

/// Blocks of kBlockWidth by kBlockHeight pixels, side by side.
struct BlockGrid {
  int columns = 0, lines = 0;
  int first_row = 4;       ///< even
  std::vector<char> seen;  ///< for each block, line by line: whether both cameras see all of it

  size_t at(int column, int line) const { return static_cast<size_t>(line) * columns + column; }
};
/// Pixels beside the grid, and at least above and below it, that derivatives need. Even.
constexpr int kGridColumn = 4, kGridRow = 4;

/// Sums over the pixels of a block in one band. They are products of the aligned images, whose means are
/// zero, and of their derivatives per pixel of the whole images. The signal is the sum of squared slopes
/// without the noise, as noise is not common to both images.
struct BandSums : PairSums {
  float count = 0;  ///< pixels

  void add(const BandSums& other);
};

/// For the blocks that are seen; others have a count of 0. left, right: CV_32F, reduced by factor.
void addUp(const cv::Mat& left, const cv::Mat& right, int factor, const BlockGrid& grid,
           std::vector<BandSums>& sums);

/// The same for each block with its up to eight neighbours.
void addNeighbours(const BlockGrid& grid, const std::vector<BandSums>& sums, std::vector<BandSums>& around);

}  // namespace uav_landing
