#pragma once

#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Size of the blocks of PhotometricBlocks, pixels.
constexpr int kBlockWidth = 16, kBlockHeight = 8;
/// A number for each column of a block.
using BlockRow = std::array<float, kBlockWidth>;

/// Of all columns, one after the other. Not merged with other sums, which would take longer than the adding.
[[gnu::noinline]] float sumOf(const BlockRow& row);

/// Sums over a block of what the warped right image r is, squared, and times the block's values.
struct BlockSums {
  float r, squares, greys, slopes;
};

/// right: the right image (mono8); row: of the block's first pixel. first: its place there, which moves by
/// down from row to row; step: from pixel to pixel. All that is interpolated from, two pixels to each side,
/// must be inside. Counted from the grey level reference, so that floats are exact enough for the differences
/// of sums. grey, slope: the block's values, row by row.
BlockSums addUp(const cv::Mat& right, int row, double first, double down, float step, float reference,
                const float* grey, const float* slope);

}  // namespace uav_landing
