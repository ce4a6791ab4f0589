#include "stereo/bands/band_sums.h"

#include <algorithm>

namespace uav_landing {
namespace {

/// From derivatives by pixels of a reduced image to those by pixels of the whole images.
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
      sums[at] = {addUpPair(left.ptr<float>(v) + u, right.ptr<float>(v) + u, stride, width, height),
                  static_cast<float>(width * height)};
      scaleSlopes(factor, sums[at]);
    }
  }
}

void addNeighbours(const BlockGrid& grid, const std::vector<BandSums>& sums, std::vector<BandSums>& around) {
  around.assign(sums.size(), {});
  std::vector<BandSums> columns(grid.columns);  // of three lines, or two at an edge
  for (int line = 0; line < grid.lines; ++line) {
    for (int column = 0; column < grid.columns; ++column) {
      columns[column] = {};
      for (int j = std::max(line - 1, 0); j <= std::min(line + 1, grid.lines - 1); ++j)
        columns[column].add(sums[grid.at(column, j)]);
    }
    for (int column = 0; column < grid.columns; ++column) {
      BandSums& total = around[grid.at(column, line)];
      for (int i = std::max(column - 1, 0); i <= std::min(column + 1, grid.columns - 1); ++i)
        total.add(columns[i]);
    }
  }
}

}  // namespace uav_landing
