#include "stereo/photometric/band_sums.h"

#include <algorithm>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

// Of fourth order: the difference of two neighbours sees too little of fine texture.
[[gnu::always_inline]] inline void derivative(const float* at, std::ptrdiff_t step, Lanes& out) {
  Lanes before2, before, after, after2;
  load(at - 2 * step, before2);
  load(at - step, before);
  load(at + step, after);
  load(at + 2 * step, after2);
  out = (8.f * (after - before) - (after2 - before2)) / 12.f;
}

UAV_LANDING_MULTIVERSION BandSums addUpBlock(const float* left, const float* right, std::ptrdiff_t stride,
                                             int width, int height) {
  Lanes lefts{}, rights{}, products{}, slope_left{}, slope_right{}, slopes{}, down{}, signal{};
  for (int y = 0; y < height; ++y, left += stride, right += stride) {
    for (int x = 0; x < width; x += kLanes) {
      Lanes l, before, after, below, r, beside;
      load(left + x, l);
      load(left + x - 1, before);
      load(left + x + 1, after);
      load(right + x, r);
      derivative(left + x, stride, below);
      derivative(right + x, 1, beside);
      const Lanes slope = 0.5f * (after - before);
      lefts += l * l;
      rights += r * r;
      products += l * r;
      slope_left += slope * l;
      slope_right += slope * r;
      slopes += slope * slope;
      down += slope * below;
      signal += slope * beside;
    }
  }
  BandSums sums;
  sums.count = static_cast<float>(width * height);
  sums.left = sum(lefts);
  sums.right = sum(rights);
  sums.products = sum(products);
  sums.slope_left = sum(slope_left);
  sums.slope_right = sum(slope_right);
  sums.slopes = sum(slopes);
  sums.down = sum(down);
  sums.signal = sum(signal);
  return sums;
}

/// From derivatives by pixels of a reduced image to those of the whole ones.
void scaleSlopes(int factor, BandSums& sums) {
  const float one = 1.F / static_cast<float>(factor), two = one * one;
  sums.slope_left *= one;
  sums.slope_right *= one;
  sums.slopes *= two;
  sums.down *= two;
  sums.signal *= two;
}

}  // namespace

void BandSums::add(const BandSums& other) {
  count += other.count;
  left += other.left;
  right += other.right;
  products += other.products;
  slope_left += other.slope_left;
  slope_right += other.slope_right;
  slopes += other.slopes;
  down += other.down;
  signal += other.signal;
}

void addUp(const cv::Mat& left, const cv::Mat& right, int factor, const BlockGrid& grid,
           std::vector<BandSums>& sums) {
  const int width = kBlockWidth / factor, height = kBlockHeight / factor;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(left.step1());
  sums.assign(grid.seen.size(), {});
  for (int line = 0; line < grid.lines; ++line) {
    const int v = grid.first_row / factor + line * height;
    for (int column = 0; column < grid.columns; ++column) {
      const size_t at = grid.at(column, line);
      if (!grid.seen[at]) continue;
      const int u = kGridColumn / factor + column * width;
      sums[at] = addUpBlock(left.ptr<float>(v) + u, right.ptr<float>(v) + u, stride, width, height);
      scaleSlopes(factor, sums[at]);
    }
  }
}

void addNeighbours(const BlockGrid& grid, const std::vector<BandSums>& sums, std::vector<BandSums>& around) {
  around.assign(sums.size(), {});
  for (int line = 0; line < grid.lines; ++line) {
    for (int column = 0; column < grid.columns; ++column) {
      BandSums& total = around[grid.at(column, line)];
      for (int j = std::max(line - 1, 0); j <= std::min(line + 1, grid.lines - 1); ++j)
        for (int i = std::max(column - 1, 0); i <= std::min(column + 1, grid.columns - 1); ++i)
          total.add(sums[grid.at(i, j)]);
    }
  }
}

}  // namespace uav_landing
