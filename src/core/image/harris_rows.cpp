#include "image/harris_rows.h"

#include <algorithm>

#include "base/multiversion.h"

namespace uav_landing {
namespace {

/// Three rows of an image, one above the other.
template <class Pixel>
struct Rows {
  const Pixel *above, *middle, *below;

  static Rows around(const cv::Mat& image, int v) {
    return {image.ptr<Pixel>(v - 1), image.ptr<Pixel>(v), image.ptr<Pixel>(v + 1)};
  }
};

/// xx, xy, yy: products of the 3x3 Sobel gradients of the middle row.
template <class Pixel>
inline void multiplyGradients(const Rows<Pixel>& rows, int columns, float* __restrict xx,
                              float* __restrict xy, float* __restrict yy) {
  const Pixel *a = rows.above, *b = rows.middle, *c = rows.below;
  for (int u = 1; u < columns - 1; ++u) {
    const auto gx = a[u + 1] + 2 * b[u + 1] + c[u + 1] - a[u - 1] - 2 * b[u - 1] - c[u - 1];
    const auto gy = c[u - 1] + 2 * c[u] + c[u + 1] - a[u - 1] - 2 * a[u] - a[u + 1];
    const float x = static_cast<float>(gx), y = static_cast<float>(gy);
    xx[u] = x * x;
    xy[u] = x * y;
    yy[u] = y * y;
  }
}
UAV_LANDING_MULTIVERSION void multiply(const Rows<uchar>& rows, int columns, float* xx, float* xy,
                                       float* yy) {
  multiplyGradients(rows, columns, xx, xy, yy);
}
UAV_LANDING_MULTIVERSION void multiply(const Rows<float>& rows, int columns, float* xx, float* xy,
                                       float* yy) {
  multiplyGradients(rows, columns, xx, xy, yy);
}

UAV_LANDING_MULTIVERSION void addRows(const Rows<float>& rows, int count, float* __restrict sum) {
  UAV_LANDING_UNROLL
  for (int i = 0; i < count; ++i) sum[i] = rows.above[i] + rows.middle[i] + rows.below[i];
}

/// From the three products' sums over the three rows.
UAV_LANDING_MULTIVERSION void respond(const float* xx, const float* xy, const float* yy, int columns, float k,
                                      float* __restrict response) {
  UAV_LANDING_UNROLL
  for (int u = 2; u < columns - 2; ++u) {
    const float a = xx[u - 1] + xx[u] + xx[u + 1], b = xy[u - 1] + xy[u] + xy[u + 1],
                c = yy[u - 1] + yy[u] + yy[u + 1];
    response[u] = a * c - b * b - k * (a + c) * (a + c);
  }
}

inline float larger(float a, float b) { return a > b ? a : b; }

/// A maximum is larger than its neighbours before it, and not smaller than those after it.
UAV_LANDING_MULTIVERSION void markMaxima(const Rows<float>& rows, const uchar* __restrict allowed,
                                         int columns, uchar* __restrict maxima) {
  const float *a = rows.above, *b = rows.middle, *c = rows.below;
  for (int u = 2; u < columns - 2; ++u) {
    const float before = larger(larger(a[u - 1], a[u]), larger(a[u + 1], b[u - 1]));
    const float after = larger(larger(c[u - 1], c[u]), larger(c[u + 1], b[u + 1]));
    const int is_larger = b[u] > larger(before, 0.F) ? 1 : 0, not_smaller = b[u] >= after ? 1 : 0;
    maxima[u] = static_cast<uchar>(is_larger & not_smaller & allowed[u]);
  }
}

}  // namespace

HarrisRows::HarrisRows(const cv::Mat& image, double k)
    : image_(image),
      k_(static_cast<float>(k)),
      columns_(image.cols),
      products_(9 * static_cast<size_t>(columns_)),
      responses_(3 * static_cast<size_t>(columns_) + kBlock),
      sums_(3 * static_cast<size_t>(columns_)),
      maxima_((static_cast<size_t>(columns_) + kBlock - 1) / kBlock * kBlock) {}

void HarrisRows::compute(int v) {
  for (next_ = std::max(next_, v - 1); next_ <= v + 1; ++next_) {
    float *xx = productRow(next_), *xy = xx + columns_, *yy = xy + columns_;
    if (image_.depth() == CV_8U)
      multiply(Rows<uchar>::around(image_, next_), columns_, xx, xy, yy);
    else
      multiply(Rows<float>::around(image_, next_), columns_, xx, xy, yy);
  }
  addRows({productRow(v - 1), productRow(v), productRow(v + 1)}, 3 * columns_, sums_.data());
  const float *xx = sums_.data(), *xy = xx + columns_, *yy = xy + columns_;
  respond(xx, xy, yy, columns_, k_, responseRow(v));
}

const uchar* HarrisRows::maxima(int v, const uchar* allowed) {
  markMaxima({responseRow(v - 1), responseRow(v), responseRow(v + 1)}, allowed, columns_, maxima_.data());
  return maxima_.data();
}

}  // namespace uav_landing
