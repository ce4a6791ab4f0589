#include "kernels/image/slanted_row.h"

#include <algorithm>

#include "kernels/lanes/interpolation.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

constexpr int kSpan = 32;  // columns that mostly come from the same rows

// The same with the lowest place that can be interpolated.
struct BoundedRow {
  double first, slope, lowest;

  double at(int column) const { return std::clamp(first + slope * column, 1.0, lowest); }
};

// Columns begin .. end - 1 of a slanted row between the same four rows of the image.
UAV_LANDING_MULTIVERSION void interpolateColumns(const float* above, size_t stride, BoundedRow row, int whole,
                                                 int begin, int end, float* __restrict out) {
  const float *a = above, *b = a + stride, *c = b + stride, *d = c + stride;
  for (int u = begin; u < end; ++u) {
    const double place = row.first + row.slope * u;
    const double inside = place < 1.0 ? 1.0 : (place > row.lowest ? row.lowest : place);
    out[u] = parabolicBetween(a[u], b[u], c[u], d[u], static_cast<float>(inside - whole));
  }
}

void interpolate(const cv::Mat& image, const BoundedRow& row, int begin, int end, float* out) {
  const int whole = static_cast<int>(row.at(begin));
  interpolateColumns(image.ptr<float>(whole - 1), image.step1(), row, whole, begin, end, out);
}

}  // namespace

void sampleSlantedRow(const cv::Mat& image, const SlantedRow& row, float* out) {
  const BoundedRow bounded{row.first, row.slope, image.rows - 2.001};
  for (int begin = 0; begin < image.cols; begin += kSpan) {
    const int end = std::min(begin + kSpan, image.cols);
    const bool same = static_cast<int>(bounded.at(begin)) == static_cast<int>(bounded.at(end - 1));
    const int step = same ? end - begin : 1;
    for (int u = begin; u < end; u += step) interpolate(image, bounded, u, u + step, out);
  }
}

}  // namespace uav_landing
