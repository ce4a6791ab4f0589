#include "kernels/block/block_sums.h"

#include <algorithm>
#include <cmath>

#include "kernels/lanes/interpolation.h"
#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

constexpr int kWidth = kBlockWidth, kHeight = kBlockHeight;

// Pixels from which the rows of a block are interpolated. In each row the first value lies begin (0 to 2)
// behind the second pixel, and each further one a step behind the last. They are floats, made for all rows
// before any is interpolated. Neighbouring places must lie in neighbouring pixels, except for one place from
// which on they are one further.
class RowPixels {
 public:
  static bool possible(float step) { return std::abs(step - 1) * (kWidth - 1) < 0.99f; }

  // starts: the first places of the rows.
  [[gnu::always_inline]] inline void read(const cv::Mat& image, int top,
                                          const std::array<float, kHeight>& starts, float step) {
    static_assert(kHeight == kLanes, "a number for each row");
    drift_ = step - 1;
    const float most = std::max(drift_, 0.f) * kLanes;
    Lanes x;
    load(starts.data(), x);
    const Lanes last = x + step * static_cast<float>(kWidth - 1) - static_cast<float>(kWidth - 1);
    IntLanes first;
    Lanes before;
    truncate(x < last ? x : last, first);
    convert(first, before);
    const Lanes begin = x - before;
    for (int k = 0; k < kParts; ++k) {
      const Lanes here = begin + drift_ * static_cast<float>(k * kLanes);
      const IntLanes none_further = here + most < 0.999f;
      store(here, begin_[k].data());
      store(none_further, none_further_[k].data());
    }
    const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(image.step);
    const uchar* above = image.ptr<uchar>(top) - 1;
    for (int y = 0; y < kHeight; ++y) {
      const uchar* row = above + y * stride + first[y];
      for (int i = 0; i < kRead; i += kLanes) {
        Lanes pixels;
        convert(row + i, pixels);
        store(pixels, &pixel_[y][i]);
      }
    }
  }

  // The k-th kLanes values of row y.
  [[gnu::always_inline]] inline void interpolate(int y, int k, Lanes& values) const {
    const float* p = &pixel_[y][k * kLanes];
    Lanes t;
    progress(begin_[k][y], drift_, t);
    if (none_further_[k][y] != 0) {
      parabolicBetween({p, p + 1, p + 2, p + 3}, t, values);
    } else {
      parabolicBetween({p, p + 1, p + 2, p + 3, p + 4}, t, values);
    }
  }

 private:
  static constexpr int kRead = kWidth + kLanes;  // more than the kWidth + 4 needed: whole vector registers
  static constexpr int kParts = kWidth / kLanes;
  std::array<std::array<float, kRead>, kHeight> pixel_;
  std::array<std::array<float, kHeight>, kParts> begin_;
  std::array<std::array<int, kHeight>, kParts> none_further_;  // whether none of these values is one further
  float drift_;
};

// Grey levels of a row at any places x, x + step, ..., one by one.
inline void sampleRow(const uchar* row, float x, float step, BlockRow& value) {
  for (int i = 0; i < kWidth; ++i) {
    const float place = x + step * static_cast<float>(i);
    const int column = static_cast<int>(place);
    const uchar* p = row + column;
    value[i] = parabolicBetween(p[-1], p[0], p[1], p[2], place - static_cast<float>(column));
  }
}

// Sums over the columns. values: function (row, k, Lanes&) of the k-th kLanes values. Values are counted from
// the grey level reference, so that floats are exact enough for differences of sums.
struct ColumnSums {
  BlockRow r, squares, greys, slopes;

  template <typename Values>
  [[gnu::always_inline]] inline void addUp(const Values& values, float reference, const float* grey,
                                           const float* slope) {
    for (int k = 0; k < kWidth / kLanes; ++k) {
      Lanes r_sums{}, square_sums{}, grey_sums{}, slope_sums{};
      for (int y = 0; y < kHeight; ++y) {
        const int at = y * kWidth + k * kLanes;
        Lanes value, own_grey, own_slope;
        values(y, k, value);
        load(grey + at, own_grey);
        load(slope + at, own_slope);
        value -= reference;
        r_sums += value;
        square_sums += value * value;
        grey_sums += value * own_grey;
        slope_sums += value * own_slope;
      }
      store(r_sums, &r[k * kLanes]);
      store(square_sums, &squares[k * kLanes]);
      store(grey_sums, &greys[k * kLanes]);
      store(slope_sums, &slopes[k * kLanes]);
    }
  }
};

}  // namespace

float sumOf(const BlockRow& row) {
  float total = 0;
  for (const float value : row) total += value;
  return total;
}

UAV_LANDING_MULTIVERSION BlockSums addUp(const cv::Mat& image, int row, double first, double down, float step,
                                         float reference, const float* grey, const float* slope) {
  std::array<float, kHeight> starts;
  for (int y = 0; y < kHeight; ++y) starts[y] = static_cast<float>(first + down * y);
  ColumnSums sums;
  if (RowPixels::possible(step)) {
    RowPixels pixels;
    pixels.read(image, row, starts, step);
    sums.addUp([&](int y, int k, Lanes& value) { pixels.interpolate(y, k, value); }, reference, grey, slope);
  } else {
    std::array<BlockRow, kHeight> sampled;
    for (int y = 0; y < kHeight; ++y) sampleRow(image.ptr<uchar>(row + y), starts[y], step, sampled[y]);
    sums.addUp([&](int y, int k, Lanes& value) { load(&sampled[y][k * kLanes], value); }, reference, grey,
               slope);
  }
  return {sumOf(sums.r), sumOf(sums.squares), sumOf(sums.greys), sumOf(sums.slopes)};
}

}  // namespace uav_landing
