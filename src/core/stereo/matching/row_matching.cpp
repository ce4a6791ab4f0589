#include "stereo/matching/row_matching.h"

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

constexpr float kNoScore = -1.f;
constexpr int kUsualStride = 24;  // of what usual windows are looked for in, where the plane is known

// Rows of places of which each is in the column after that of the one before or, from one of them on, in the
// one after that or still the same: row j at start + j by_row, and on by step.
struct PlaceRows {
  double start, by_row, step;
  int count;

  double at(int row) const { return start + by_row * row; }
  // Where the columns are counted from.
  double least(double place) const { return std::min(place, place + (step - 1) * (count - 1)); }
  bool possible() const { return std::abs(step - 1) * (count - 1) < 0.99; }
  bool inside(int row, int columns) const {
    return least(at(row)) >= 0 && least(at(row)) + count + 2 <= columns;
  }
};

// A row's values, less the mean, at count places: the first this far behind the row's first pixel, and each
// one column and the drift behind the one before.
[[gnu::always_inline]] inline void interpolateRow(const float* row, float start, float drift, int count,
                                                  float mean, float* out) {
  // Up to this no place is in the next column but one, whatever is lost in rounding.
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

// Where the places of rows begin: columns before the first ones, and how far these are behind them. All rows
// at once, filled up to whole lanes.
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

// Values at the places in the image's rows from v on, less the mean, by linear interpolation.
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

// Sums and sums of squares of the columns of a strip of rows. stride: of whole lanes.
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

// What the scores at kLanes neighbouring positions of a strip are made of.
struct BlockSums {
  alignas(32) std::array<float, kLanes> cross, sums, squares;
};

// Products of a square window with what is below it, and sums of the strip's columns and squares there.
[[gnu::always_inline]] inline void addUpAny(const float* window, const float* strip, const float* column_sums,
                                            const float* column_squares, int size, int stride,
                                            BlockSums& block) {
  Lanes cross{}, sums{}, squares{};
  for (int j = 0; j < size; ++j, strip += stride) {
    Lanes row{};  // sums of their own, so that rows need not wait for each other
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
                                    const float* column_squares, int size, int stride, BlockSums& block) {
  if (size == kUsualWindowSize) {
    addUpAny(window, strip, column_sums, column_squares, kUsualWindowSize, stride, block);
  } else {
    addUpAny(window, strip, column_sums, column_squares, size, stride, block);
  }
}

// Correlations of a window of this energy with what the sums are of. Nowhere without contrast, nor outside
// the image, where the sums are no numbers.
void correlate(const BlockSums& block, double count, double energy, float* scores) {
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
void compare(const BlockSums& block, double energy, float* scores) {
  for (int k = 0; k < kLanes; ++k) {
    const double cross = block.cross[k], squares = block.squares[k];
    scores[k] = static_cast<float>(
        std::isnan(block.sums[k]) ? kNoScore : 1.0 - (energy - 2.0 * cross + squares) / (2.0 * energy));
  }
}

}  // namespace

RowSearch::RowSearch(const cv::Mat& reference, const cv::Mat& other, int radius, MatchingCost cost)
    : reference_(reference), other_(other), radius_(radius), cost_(cost) {}

bool RowSearch::run(int u, int v, double centre, int steps, const RowWarp& warp) {
  scores_.clear();
  if (!template_.load(reference_, u, v, radius_)) return false;
  const int size = 2 * radius_ + 1, width = size + 2 * steps;
  steps_ = steps;
  centre_ = centre;
  scale_ = warp.scale;
  padded_ = wholeLanes(2 * steps + 1);
  stride_ = wholeLanes(padded_ + size - 1);
  strip_.resize(static_cast<size_t>(stride_) * size);
  resample(v, width, warp);
  scoreAll();
  return true;
}

void RowSearch::resample(int v, int width, const RowWarp& warp) {
  const int size = 2 * radius_ + 1;
  const float mean = static_cast<float>(template_.mean);
  const PlaceRows places{centre_ - warp.shear * radius_ - scale_ * (radius_ + steps_), warp.shear, scale_,
                         stride_};
  if (places.possible() && places.inside(0, other_.cols) && places.inside(size - 1, other_.cols)) {
    interpolate(other_, v - radius_, places, size, mean, strip_.data());
    return;
  }
  for (int j = 0; j < size; ++j) {
    const float* row = other_.ptr<float>(v - radius_ + j);
    float* out = strip_.data() + static_cast<size_t>(j) * stride_;
    for (int i = 0; i < width; ++i) {
      const double x = places.at(j) + scale_ * i;
      out[i] = x >= 0 && x < other_.cols - 1 ? linearAt(row, static_cast<float>(x)) - mean
                                             : std::numeric_limits<float>::quiet_NaN();
    }
    std::fill(out + width, out + stride_, 0.f);
  }
}

void RowSearch::scoreAll() {
  const int size = 2 * radius_ + 1;
  column_sums_.resize(stride_);
  column_squares_.resize(stride_);
  addColumns(strip_.data(), size, stride_, column_sums_.data(), column_squares_.data());
  scores_.resize(padded_);
  const double pixels = static_cast<double>(template_.values.size()), energy = template_.energy;
  BlockSums block;
  for (int first = 0; first < padded_; first += kLanes) {
    addUp(template_.values.data(), strip_.data() + first, column_sums_.data() + first,
          column_squares_.data() + first, size, stride_, block);
    if (cost_ == MatchingCost::kSsd) {
      compare(block, energy, &scores_[first]);
    } else {
      correlate(block, pixels, energy, &scores_[first]);
    }
  }
  scores_.resize(2 * steps_ + 1);  // without what fills up
}

RowCandidate RowSearch::interpolated(int index) const {
  double offset = 0;
  const double s = scores_[index];
  if (index > 0 && index + 1 < static_cast<int>(scores_.size())) {
    const double before = scores_[index - 1], after = scores_[index + 1];
    const double curvature = before - 2 * s + after;
    if (before > kNoScore && after > kNoScore && curvature < 0) offset = 0.5 * (before - after) / curvature;
  }
  return {centre_ + scale_ * (index - steps_ + offset), s};
}

RowCandidate RowSearch::best(double* second_score) const {
  const auto peak = std::max_element(scores_.begin(), scores_.end());
  if (peak == scores_.end()) return {0, kNoScore};
  const int index = static_cast<int>(peak - scores_.begin());
  if (second_score) {
    *second_score = kNoScore;
    for (int k = 1; k + 1 < static_cast<int>(scores_.size()); ++k) {
      if (std::abs(k - index) > 2 && scores_[k] >= scores_[k - 1] && scores_[k] >= scores_[k + 1]) {
        *second_score = std::max<double>(*second_score, scores_[k]);
      }
    }
  }
  return interpolated(index);
}

std::vector<RowCandidate> RowSearch::peaks(double min_score, int count) const {
  std::vector<RowCandidate> found;
  for (int k = 0; k < static_cast<int>(scores_.size()); ++k) {
    const bool rises = k == 0 || scores_[k] > scores_[k - 1];
    const bool falls = k + 1 == static_cast<int>(scores_.size()) || scores_[k] >= scores_[k + 1];
    if (scores_[k] >= min_score && rises && falls) found.push_back(interpolated(k));
  }
  std::sort(found.begin(), found.end(),
            [](const RowCandidate& a, const RowCandidate& b) { return a.score > b.score; });
  if (found.size() > static_cast<size_t>(count)) found.resize(count);
  return found;
}

}  // namespace uav_landing
