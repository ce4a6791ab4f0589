#include "image/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/multiversion.h"

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

/// One row of the result from three of the image. columns: mixed vertically, with a place before the first
/// and one behind the last.
template <class Pixel>
inline void smoothRow(const Pixel* above, const Pixel* row, const Pixel* below, int size, Kernel kernel,
                      float* __restrict columns, float* __restrict out) {
  UAV_LANDING_UNROLL
  for (int u = 0; u < size; ++u)
    columns[u + 1] =
        kernel.middle * static_cast<float>(row[u]) + kernel.side * static_cast<float>(above[u] + below[u]);
  columns[0] = columns[2];
  columns[size + 1] = columns[size - 1];
  UAV_LANDING_UNROLL
  for (int u = 0; u < size; ++u)
    out[u] = kernel.middle * columns[u + 1] + kernel.side * (columns[u] + columns[u + 2]);
}
UAV_LANDING_MULTIVERSION void smoothRowOf8Bit(const uchar* above, const uchar* row, const uchar* below,
                                              int size, Kernel kernel, float* columns, float* out) {
  smoothRow(above, row, below, size, kernel, columns, out);
}
UAV_LANDING_MULTIVERSION void smoothRowOfFloat(const float* above, const float* row, const float* below,
                                               int size, Kernel kernel, float* columns, float* out) {
  smoothRow(above, row, below, size, kernel, columns, out);
}

UAV_LANDING_MULTIVERSION void addRow(const uchar* __restrict row, int size, std::uint16_t* __restrict sums) {
  UAV_LANDING_UNROLL
  for (int u = 0; u < size; ++u) sums[u] = static_cast<std::uint16_t>(sums[u] + row[u]);
}
UAV_LANDING_MULTIVERSION void meanOfTwo(const std::uint16_t* __restrict sums, int size, float scale,
                                        float* __restrict out) {
  for (int u = 0; u < size; ++u) out[u] = scale * static_cast<float>(sums[2 * u] + sums[2 * u + 1]);
}
void meanOfMore(const std::uint16_t* sums, int size, int factor, float scale, float* out) {
  for (int u = 0; u < size; ++u) {
    int sum = 0;
    for (int k = 0; k < factor; ++k) sum += sums[u * factor + k];
    out[u] = scale * static_cast<float>(sum);
  }
}

/// A row of the means over blocks. sums: memory for the columns of the image.
void reduceRow(const cv::Mat& image, int factor, int row, std::vector<std::uint16_t>& sums, float* out,
               int size) {
  const float scale = 1.F / static_cast<float>(factor * factor);
  std::fill(sums.begin(), sums.end(), std::uint16_t(0));
  for (int k = 0; k < factor; ++k)
    addRow(image.ptr<uchar>(row * factor + k), static_cast<int>(sums.size()), sums.data());
  if (factor == 2)
    meanOfTwo(sums.data(), size, scale, out);
  else
    meanOfMore(sums.data(), size, factor, scale, out);
}

}  // namespace

void smooth(const cv::Mat& image, const cv::Range& rows, cv::Mat& smoothed) {
  std::vector<float> columns(image.cols + 2);
  for (int v = rows.start; v < rows.end; ++v) {
    const int above = cv::borderInterpolate(v - 1, image.rows, cv::BORDER_REFLECT_101);
    const int below = cv::borderInterpolate(v + 1, image.rows, cv::BORDER_REFLECT_101);
    smoothRowOf8Bit(image.ptr<uchar>(above), image.ptr<uchar>(v), image.ptr<uchar>(below), image.cols,
                    kernel(), columns.data(), smoothed.ptr<float>(v));
  }
}

void smoothReduced(const cv::Mat& image, int factor, const cv::Range& rows, cv::Mat& smoothed) {
  const int count = smoothed.rows, size = smoothed.cols;
  std::vector<std::uint16_t> sums(static_cast<size_t>(size) * factor);
  std::vector<float> reduced(3 * static_cast<size_t>(size)), columns(size + 2);  // the last three rows
  const auto reducedRow = [&](int v) { return &reduced[static_cast<size_t>(v % 3) * size]; };
  int next = std::max(rows.start - 1, 0);
  for (int v = rows.start; v < rows.end; ++v) {
    for (; next <= std::min(v + 1, count - 1); ++next)
      reduceRow(image, factor, next, sums, reducedRow(next), size);
    const float* above = reducedRow(cv::borderInterpolate(v - 1, count, cv::BORDER_REFLECT_101));
    const float* below = reducedRow(cv::borderInterpolate(v + 1, count, cv::BORDER_REFLECT_101));
    smoothRowOfFloat(above, reducedRow(v), below, size, kernel(), columns.data(), smoothed.ptr<float>(v));
  }
}

}  // namespace uav_landing
