#include "kernels/image/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

/// Weights of a pixel and of each of its two neighbours.
struct Kernel {
  float middle, side;
};

Kernel gaussian(double sigma) {
  const double side = std::exp(-0.5 / (sigma * sigma)), sum = 1 + 2 * side;
  return {static_cast<float>(1 / sum), static_cast<float>(side / sum)};
}
const Kernel& kernel() {
  static const Kernel kernel = gaussian(0.7);
  return kernel;
}

/// One row of the result from three of the image. columns: memory for the vertically mixed row, with one
/// place before the first and one behind the last.
UAV_LANDING_MULTIVERSION void smoothRow(const float* above, const float* row, const float* below, int size,
                                        Kernel kernel, float* __restrict columns, float* __restrict out) {
  UAV_LANDING_UNROLL
  for (int u = 0; u < size; ++u)
    columns[u + 1] = kernel.middle * row[u] + kernel.side * (above[u] + below[u]);
  columns[0] = columns[2];
  columns[size + 1] = columns[size - 1];
  UAV_LANDING_UNROLL
  for (int u = 0; u < size; ++u)
    out[u] = kernel.middle * columns[u + 1] + kernel.side * (columns[u] + columns[u + 2]);
}

/// Smooths some rows of an image that is made row by row by makeRow(v, out). Only the last three rows are
/// kept.
template <class MakeRow>
void smoothRows(const MakeRow& makeRow, const cv::Range& rows, cv::Mat& smoothed) {
  const int count = smoothed.rows, size = smoothed.cols;
  std::vector<float> made(3 * static_cast<size_t>(size)), columns(size + 2);
  const auto madeRow = [&](int v) { return &made[static_cast<size_t>(v % 3) * size]; };
  int next = std::max(rows.start - 1, 0);
  for (int v = rows.start; v < rows.end; ++v) {
    for (; next <= std::min(v + 1, count - 1); ++next) makeRow(next, madeRow(next));
    const float* above = madeRow(cv::borderInterpolate(v - 1, count, cv::BORDER_REFLECT_101));
    const float* below = madeRow(cv::borderInterpolate(v + 1, count, cv::BORDER_REFLECT_101));
    smoothRow(above, madeRow(v), below, size, kernel(), columns.data(), smoothed.ptr<float>(v));
  }
}

UAV_LANDING_MULTIVERSION void toFloats(const uchar* row, int size, float* out) {
  int u = 0;
  UAV_LANDING_UNROLL
  for (; u + kLanes <= size; u += kLanes) {
    Lanes greys;
    convert(row + u, greys);
    store(greys, out + u);
  }
  for (; u < size; ++u) out[u] = row[u];
}

/// Means over two by two pixels. Two neighbours are read as one number, which works for either byte order.
UAV_LANDING_MULTIVERSION void meanOfFour(const uchar* upper, const uchar* lower, int size, float scale,
                                         float* __restrict out) {
  for (int u = 0; u < size; ++u) {
    std::uint16_t a, b;
    std::memcpy(&a, upper + 2 * static_cast<std::ptrdiff_t>(u), sizeof(a));
    std::memcpy(&b, lower + 2 * static_cast<std::ptrdiff_t>(u), sizeof(b));
    const int sum = (a & 255) + (a >> 8) + (b & 255) + (b >> 8);
    out[u] = scale * static_cast<float>(sum);
  }
}

UAV_LANDING_MULTIVERSION void addRow(const uchar* __restrict row, int size, std::uint16_t* __restrict sums) {
  UAV_LANDING_UNROLL
  for (int u = 0; u < size; ++u) sums[u] = static_cast<std::uint16_t>(sums[u] + row[u]);
}
void meanOfMore(const std::uint16_t* sums, int size, int factor, float scale, float* out) {
  for (int u = 0; u < size; ++u) {
    int sum = 0;
    for (int k = 0; k < factor; ++k) sum += sums[u * factor + k];
    out[u] = scale * static_cast<float>(sum);
  }
}

/// A row of means over blocks. sums: memory for the columns of the image.
void reduceRow(const cv::Mat& image, int factor, int row, std::vector<std::uint16_t>& sums, float* out,
               int size) {
  const float scale = 1.F / static_cast<float>(factor * factor);
  if (factor == 2) {
    meanOfFour(image.ptr<uchar>(2 * row), image.ptr<uchar>(2 * row + 1), size, scale, out);
    return;
  }
  std::fill(sums.begin(), sums.end(), std::uint16_t(0));
  for (int k = 0; k < factor; ++k)
    addRow(image.ptr<uchar>(row * factor + k), static_cast<int>(sums.size()), sums.data());
  meanOfMore(sums.data(), size, factor, scale, out);
}

}  // namespace

void smooth(const cv::Mat& image, const cv::Range& rows, cv::Mat& smoothed) {
  smoothRows([&](int v, float* out) { toFloats(image.ptr<uchar>(v), image.cols, out); }, rows, smoothed);
}

void smoothReduced(const cv::Mat& image, int factor, const cv::Range& rows, cv::Mat& smoothed) {
  std::vector<std::uint16_t> sums(static_cast<size_t>(smoothed.cols) * factor);
  smoothRows([&](int v, float* out) { reduceRow(image, factor, v, sums, out, smoothed.cols); }, rows,
             smoothed);
}

}  // namespace uav_landing
