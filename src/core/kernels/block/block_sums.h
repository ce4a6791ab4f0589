#pragma once

#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Size of the blocks, pixels.
constexpr int kBlockWidth = 16, kBlockHeight = 8;
/// A number for each column of a block.
using BlockRow = std::array<float, kBlockWidth>;

/// Of all columns, one after the other. Not merged with other sums, which would take longer than the adding.
[[gnu::noinline]] float sumOf(const BlockRow& row);

/// Sums over a block of the values r that an image has at its places, of their squares, and of their products
/// with two numbers of each pixel of the block.
struct BlockSums {
  float r, squares, greys, slopes;
};

/// image: mono8; row: of the block's first pixel. first: its place there, which moves by down from row to
/// row; step: from pixel to pixel. Values between pixels are interpolated. All that they are interpolated
/// from, two pixels to each side, must be inside. Counted from the grey level reference, so that floats are
/// exact enough for the differences of sums. grey, slope: the block's numbers, row by row.
BlockSums addUp(const cv::Mat& image, int row, double first, double down, float step, float reference,
                const float* grey, const float* slope);

}  // namespace uav_landing
