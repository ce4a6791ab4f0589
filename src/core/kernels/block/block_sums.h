#pragma once

#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Size of the blocks, pixels.
constexpr int kBlockWidth = 16, kBlockHeight = 8;
/// One number per column of a block.
using BlockRow = std::array<float, kBlockWidth>;

/// Sum over all columns, one after the other. It is not inlined: merged with other sums it would take longer.
[[gnu::noinline]] float sumOf(const BlockRow& row);

/// Sums over a block of the values r of an image at its places, of their squares, and of their products with
/// two numbers per pixel of the block.
struct BlockSums {
  float r, squares, greys, slopes;
};

/// image: mono8. row: of the block's first pixel. first: column of its place; it moves by down from row to
/// row. step: from pixel to pixel. Values between pixels are interpolated; the pixels for that, two on each
/// side, must be inside the image. reference: grey level that values are counted from, so that floats are
/// exact enough for differences of sums. grey, slope: the block's numbers, row by row.
BlockSums addUp(const cv::Mat& image, int row, double first, double down, float step, float reference,
                const float* grey, const float* slope);

}  // namespace uav_landing
