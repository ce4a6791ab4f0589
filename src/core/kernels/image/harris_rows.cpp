#include "kernels/image/harris_rows.h"

#include <algorithm>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/lanes/comparison.h"
#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

/// Three rows of an image, one below the other.
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

/// Response from the sums of the three products over the three rows.
UAV_LANDING_MULTIVERSION void respond(const float* xx, const float* xy, const float* yy, int columns, float k,
                                      float* __restrict response) {
  UAV_LANDING_UNROLL
  for (int u = 2; u < columns - 2; ++u) {
    const float a = xx[u - 1] + xx[u] + xx[u + 1], b = xy[u - 1] + xy[u] + xy[u + 1],
                c = yy[u - 1] + yy[u] + yy[u + 1];
    response[u] = a * c - b * b - k * (a + c) * (a + c);
  }
}

/// Whether pixels are larger than their neighbours before them, and not smaller than those after them.
[[gnu::always_inline]] inline void findMaxima(const float* above, const float* row, const float* below,
                                              IntLanes& is_maximum) {
  Lanes left, middle, right, beside, before, after;
  load(above - 1, left);
  load(above, middle);
  load(above + 1, right);
  load(row - 1, beside);
  larger(left, middle, left);
  larger(right, beside, right);
  larger(left, right, before);
  load(below - 1, left);
  load(below, middle);
  load(below + 1, right);
  load(row + 1, beside);
  larger(left, middle, left);
  larger(right, beside, right);
  larger(left, right, after);
  load(row, middle);
  IntLanes above_before, not_below_after;
  less(before, middle, above_before);
  atMost(after, middle, not_below_after);
  is_maximum = above_before & not_below_after;
}

[[gnu::always_inline]] inline cv::v_int16x8 packed(const IntLanes& m) {
  using Half = int __attribute__((vector_size(sizeof(Lanes) / 2)));
  using Register = decltype(cv::v_int32x4::val);
  return cv::v_pack(cv::v_int32x4((Register)(Half{m[0], m[1], m[2], m[3]})),
                    cv::v_int32x4((Register)(Half{m[4], m[5], m[6], m[7]})));
}

/// One bit for each pixel of the middle row's blocks.
UAV_LANDING_MULTIVERSION void markMaxima(const Rows<float>& rows, int blocks,
                                         std::uint64_t* __restrict marks) {
  constexpr int kTogether = 2 * kLanes;
  const float *a = rows.above, *b = rows.middle, *c = rows.below;
  for (int block = 0; block < blocks; ++block) {
    std::uint64_t bits = 0;
    for (int i = 0; i < HarrisRows::kBlock; i += kTogether, a += kTogether, b += kTogether, c += kTogether) {
      IntLanes first, second;
      findMaxima(a, b, c, first);
      findMaxima(a + kLanes, b + kLanes, c + kLanes, second);
      const int some = cv::v_signmask(cv::v_pack(packed(first), packed(second)));
      bits |= static_cast<std::uint64_t>(some) << i;
    }
    marks[block] = bits;
  }
}

}  // namespace

HarrisRows::HarrisRows(const cv::Mat& image, double k)
    : image_(image),
      k_(static_cast<float>(k)),
      columns_(image.cols),
      products_(9 * static_cast<size_t>(columns_)),
      blocks_((columns_ + kBlock - 1) / kBlock),
      responses_(3 * static_cast<size_t>(blocks_) * kBlock + 2 * kAround),
      sums_(3 * static_cast<size_t>(columns_)),
      maxima_(blocks_) {}

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

const std::uint64_t* HarrisRows::maxima(int v) {
  markMaxima({responseRow(v - 1), responseRow(v), responseRow(v + 1)}, blocks_, maxima_.data());
  return maxima_.data();
}

}  // namespace uav_landing
