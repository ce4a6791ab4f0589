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
  std::vector<char> seen;  ///< for each, line by line, whether both cameras see all of it

  size_t at(int column, int line) const { return static_cast<size_t>(line) * columns + column; }
};
/// Pixels beside a grid, and at least above and below it, for derivatives. Even.
constexpr int kGridColumn = 4, kGridRow = 4;

/// Sums over the pixels of a block of one band: of what the aligned images (their means are zero) have in
/// common, and of their derivatives, per pixel of the whole images. The signal is slopes without the noise,
/// which is not in common.
struct BandSums : PairSums {
  float count = 0;  ///< pixels

  void add(const BandSums& other);
};

/// Of the blocks that are seen, others have a count of 0. left, right: CV_32F, reduced by factor.
void addUp(const cv::Mat& left, const cv::Mat& right, int factor, const BlockGrid& grid,
           std::vector<BandSums>& sums);

/// The same of each block with its up to eight neighbours.
void addNeighbours(const BlockGrid& grid, const std::vector<BandSums>& sums, std::vector<BandSums>& around);

}  // namespace uav_landing
