#include "kernels/window/strip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/lanes/interpolation.h"
#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"
#include "kernels/window/window_layout.h"

namespace uav_landing {
namespace {

constexpr int kUsualStride = 24;  // with it the compiler needs no loop for a row

// Rows of places in consecutive columns, except that from one place on they may be one column further or
// still in the same one. Row j begins at start + j by_row and goes on by step.
struct PlaceRows {
  double start, by_row, step;
  int count;

  double at(int row) const { return start + by_row * row; }
  // Column from which places are counted.
  double least(double place) const { return std::min(place, place + (step - 1) * (count - 1)); }
  bool possible() const { return std::abs(step - 1) * (count - 1) < 0.99; }
  bool inside(int row, int columns) const {
    return least(at(row)) >= 0 && least(at(row)) + count + 2 <= columns;
  }
};

// Values of a row minus the mean, at count places. start: distance of the first place behind the row's first
// pixel. Each later place is one column plus the drift behind the one before.
[[gnu::always_inline]] inline void interpolateRow(const float* row, float start, float drift, int count,
                                                  float mean, float* out) {
  // Up to this value no place is beyond the next column, whatever rounding does.
  constexpr float kSurelyBefore = 0.999F;
  const bool before = start < kSurelyBefore && start + drift * static_cast<float>(count) < kSurelyBefore;
  Lanes behind;
  progress(start, drift, behind);
  for (int i = 0; before && i < count; i += kLanes, behind += kLanes * drift) {
    Lanes a, b;
    load(row + i, a);
    load(row + i + 1, b);
    store(a + behind * (b - a) - mean, out + i);
  }
  for (int i = 0; !before && i < count; i += kLanes, behind += kLanes * drift) {
    Lanes a, b, c;
    load(row + i, a);
    load(row + i + 1, b);
    load(row + i + 2, c);
    const auto next = behind >= 1;
    const Lanes left = next ? b : a, right = next ? c : b, t = next ? behind - 1 : behind;
    store(left + t * (right - left) - mean, out + i);
  }
}

// Starts of the rows: columns before the first places, and the distances of these from there. All rows at
// once, filled up to whole lanes.
struct RowStarts {
  static constexpr int kMost = 2 * kLargestWindowRadius + kLanes;

  std::array<int, kMost> column;
  std::array<float, kMost> behind;

  [[gnu::always_inline]] inline RowStarts(const PlaceRows& places, int rows) {
    const double start = places.start, by_row = places.by_row, back = places.least(0);
    for (int j = 0; j < wholeLanes(rows); ++j) {
      const double place = start + by_row * j;
      column[j] = static_cast<int>(place + back);
      behind[j] = static_cast<float>(place - column[j]);
    }
  }
};

// Values at the places in the image's rows from v on, minus the mean, by linear interpolation.
UAV_LANDING_MULTIVERSION void interpolate(const cv::Mat& image, int v, const PlaceRows& places, int rows,
                                          float mean, float* out) {
  const float drift = static_cast<float>(places.step - 1);
  const int count = places.count;
  const RowStarts starts(places, rows);
  const float* first = image.ptr<float>(v);
  for (int j = 0; j < rows; ++j, out += count, first += rowStride(image)) {
    const float* row = first + starts.column[j];
    const float start = starts.behind[j];
    if (count == kUsualStride) {
      interpolateRow(row, start, drift, kUsualStride, mean, out);
    } else {
      interpolateRow(row, start, drift, count, mean, out);
    }
  }
}

// Sums and sums of squares of the columns of a strip of rows. stride: in whole lanes.
[[gnu::always_inline]] inline void addColumnsOfAny(const float* strip, int rows, int stride, float* sums,
                                                   float* squares) {
  for (int i = 0; i < stride; i += kLanes) {
    const float* column = strip + i;
    Lanes sum{}, square{};
    for (int j = 0; j < rows; ++j, column += stride) {
      Lanes values;
      load(column, values);
      sum += values;
      square += values * values;
    }
    store(sum, sums + i);
    store(square, squares + i);
  }
}

// The usual size is known to the compiler, which then needs no loop for a column.
UAV_LANDING_MULTIVERSION void addColumns(const float* strip, int rows, int stride, float* sums,
                                         float* squares) {
  if (rows == kUsualWindowSize && stride == kUsualStride) {
    addColumnsOfAny(strip, kUsualWindowSize, kUsualStride, sums, squares);
  } else {
    addColumnsOfAny(strip, rows, stride, sums, squares);
  }
}

// Sums from which the scores at kLanes neighbouring positions of a strip follow.
struct PositionSums {
  alignas(32) std::array<float, kLanes> cross, sums, squares;
};

// Products of a square window with the strip at its positions, and sums of the strip's columns and squares
// there.
[[gnu::always_inline]] inline void addUpAny(const float* window, const float* strip, const float* column_sums,
                                            const float* column_squares, int size, int stride,
                                            PositionSums& block) {
  Lanes cross{}, sums{}, squares{};
  for (int j = 0; j < size; ++j, strip += stride) {
    Lanes row{};  // separate sums, so that rows need not wait for each other
    for (int i = 0; i < size; ++i) {
      Lanes values;
      load(strip + i, values);
      row += *window++ * values;
    }
    cross += row;
  }
  for (int i = 0; i < size; ++i) {
    Lanes values;
    load(column_sums + i, values);
    sums += values;
    load(column_squares + i, values);
    squares += values;
  }
  store(cross, block.cross.data());
  store(sums, block.sums.data());
  store(squares, block.squares.data());
}

// The usual size is known to the compiler, which then needs no loop for a row.
UAV_LANDING_MULTIVERSION void addUp(const float* window, const float* strip, const float* column_sums,
                                    const float* column_squares, int size, int stride, PositionSums& block) {
  if (size == kUsualWindowSize) {
    addUpAny(window, strip, column_sums, column_squares, kUsualWindowSize, stride, block);
  } else {
    addUpAny(window, strip, column_sums, column_squares, size, stride, block);
  }
}

// Correlations of a window of this energy with the strip, from the sums. None without contrast, nor outside
// the image, where the sums are NaN.
void correlate(const PositionSums& block, double count, double energy, float* scores) {
  using Pair = cv::v_float64x2;
  const Pair counts = cv::v_setall_f64(count), energies = cv::v_setall_f64(energy);
  const Pair least = cv::v_setall_f64(1e-3 * energy), none = cv::v_setall_f64(kNoScore);
  const auto correlation = [&](const Pair& cross, const Pair& sum, const Pair& squares) {
    const Pair other = squares - sum * sum / counts;
    return cv::v_select(other >= least, cross / cv::v_sqrt(other * energies), none);
  };
  for (int k = 0; k < kLanes; k += cv::v_float32x4::nlanes) {
    const cv::v_float32x4 cross = cv::v_load_aligned(&block.cross[k]),
                          sums = cv::v_load_aligned(&block.sums[k]),
                          squares = cv::v_load_aligned(&block.squares[k]);
    const Pair first = correlation(cv::v_cvt_f64(cross), cv::v_cvt_f64(sums), cv::v_cvt_f64(squares));
    const Pair second =
        correlation(cv::v_cvt_f64_high(cross), cv::v_cvt_f64_high(sums), cv::v_cvt_f64_high(squares));
    cv::v_store(scores + k, cv::v_cvt_f32(first, second));
  }
}

// Sums of squared differences over twice the window's own energy: 1 when equal, 0 when unrelated.
void compare(const PositionSums& block, double energy, float* scores) {
  for (int k = 0; k < kLanes; ++k) {
    const double cross = block.cross[k], squares = block.squares[k];
    scores[k] = static_cast<float>(
        std::isnan(block.sums[k]) ? kNoScore : 1.0 - (energy - 2.0 * cross + squares) / (2.0 * energy));
  }
}

// Computes the sums for the scores, and passes each block of them on with its first position.
template <class Score>
void scoreBlocks(const CentredWindow& window, const float* strip, int stride, int count,
                 StripColumns& columns, const Score& score) {
  columns.sums.resize(stride);
  columns.squares.resize(stride);
  addColumns(strip, window.size, stride, columns.sums.data(), columns.squares.data());
  PositionSums block;
  for (int first = 0; first < count; first += kLanes) {
    addUp(window.values, strip + first, columns.sums.data() + first, columns.squares.data() + first,
          window.size, stride, block);
    score(block, first);
  }
}

}  // namespace

void sampleStrip(const cv::Mat& image, int v, const StripPlaces& places, const StripSize& size, float mean,
                 float* strip) {
  const PlaceRows rows{places.start, places.by_row, places.step, size.stride};
  if (rows.possible() && rows.inside(0, image.cols) && rows.inside(size.rows - 1, image.cols)) {
    interpolate(image, v, rows, size.rows, mean, strip);
    return;
  }
  for (int j = 0; j < size.rows; ++j) {
    const float* row = image.ptr<float>(v + j);
    float* out = strip + static_cast<size_t>(j) * size.stride;
    for (int i = 0; i < size.columns; ++i) {
      const double x = places.at(j) + places.step * i;
      out[i] = x >= 0 && x < image.cols - 1 ? linearAt(row, static_cast<float>(x)) - mean
                                            : std::numeric_limits<float>::quiet_NaN();
    }
    std::fill(out + size.columns, out + size.stride, 0.f);
  }
}

void correlateAlong(const CentredWindow& window, const float* strip, int stride, int count,
                    StripColumns& columns, float* scores) {
  const double pixels = static_cast<double>(window.size) * window.size;
  scoreBlocks(window, strip, stride, count, columns, [&](const PositionSums& block, int first) {
    correlate(block, pixels, window.energy, scores + first);
  });
}

void compareAlong(const CentredWindow& window, const float* strip, int stride, int count,
                  StripColumns& columns, float* scores) {
  scoreBlocks(window, strip, stride, count, columns,
              [&](const PositionSums& block, int first) { compare(block, window.energy, scores + first); });
}

}  // namespace uav_landing
