#include "stereo/photometric/aligned_rows.h"

#include <algorithm>
#include <cmath>

#include "kernels/window/parabolic_window.h"

namespace uav_landing {
namespace {

// Pixels that are interpolated at once.
constexpr int kTogether = 4;
// Smallest ratio of right to left pixels. Below it the ground is seen too much from the side.
constexpr double kLeastDensity = 0.2;

/// The longest run of set pixels. A distorted image may have none in the middle of a row.
cv::Range setColumns(const cv::Mat& mask, int v) {
  const uchar* row = mask.ptr<uchar>(v);
  cv::Range longest(0, 0);
  for (int begin = 0; begin < mask.cols;) {
    int end = begin;
    while (end < mask.cols && row[end] != 0) ++end;
    if (end - begin > longest.size()) longest = {begin, end};
    begin = end + 1;
  }
  return longest;
}

std::vector<cv::Range> setColumns(const cv::Mat& mask) {
  std::vector<cv::Range> columns;
  for (int v = 0; v < mask.rows; ++v) columns.push_back(setColumns(mask, v));
  return columns;
}

/// Whole columns between two places, within 0 to cols.
cv::Range between(double begin, double end, int cols) {
  return {static_cast<int>(std::ceil(std::clamp<double>(begin, 0, cols))),
          static_cast<int>(std::floor(std::clamp<double>(end, 0, cols)))};
}

/// As many of these columns as can be interpolated together.
cv::Range whole(int begin, int end) {
  return end - begin < kTogether ? cv::Range(0, 0)
                                 : cv::Range(end - (end - begin) / kTogether * kTogether, end);
}

void fillUp(const cv::Range& known, cv::Mat& image, int row) {
  float* values = image.ptr<float>(row);
  if (known.empty()) {  // between rows that are known
    if (row > 0) std::copy(image.ptr<float>(row - 1), image.ptr<float>(row - 1) + image.cols, values);
    return;
  }
  std::fill(values, values + known.start, values[known.start]);
  std::fill(values + known.end, values + image.cols, values[known.end - 1]);
}

}  // namespace

AlignedRows::AlignedRows(const cv::Mat& left_mask, const cv::Mat& right_mask)
    : size_(left_mask.size()),
      left_columns_(setColumns(left_mask)),
      right_columns_(setColumns(right_mask)),
      left_memory_(cv::Mat::zeros(size_, CV_32F)),
      right_memory_(cv::Mat::zeros(size_, CV_32F)) {}

// The highest row that may be ground, at the left or right edge.
int AlignedRows::findFirstRow(const ShiftModel& shift, double least) const {
  const auto horizon = [&](double u) { return (least - shift.c - shift.a * u) / shift.b; };
  const double highest = shift.b > 0 ? std::min(horizon(0), horizon(size_.width - 1)) : 0;
  return static_cast<int>(std::clamp<double>(std::ceil(highest), 0, size_.height));
}

cv::Range AlignedRows::seenColumns(const ShiftModel& model, double least, int v) const {
  const ShiftModel shift = model.around(0.5 * size_.width, v);
  // Pixels that interpolation reads beside a place, and by which a later model may differ from this one.
  constexpr int kAround = 5;
  const cv::Range &left = left_columns_[v], &right = right_columns_[v];
  const double density = 1 - shift.a, down = shift.b * v + shift.c;
  if (!(density > kLeastDensity) || right.size() <= 2 * kAround) return {0, 0};
  double begin = std::max<double>(left.start, (right.start + kAround + down) / density);
  double end = std::min<double>(left.end, (right.end - kAround + down) / density);
  // The horizon may cross the row.
  if (shift.a > 0) begin = std::max(begin, (least - down) / shift.a);
  if (shift.a < 0) end = std::min(end, (least - down) / shift.a);
  if (shift.a == 0 && down < least) return {0, 0};
  const cv::Range columns = between(begin, end, size_.width);
  return whole(columns.start, columns.end);
}

void AlignedRows::findRows(const ShiftModel& shift, double least) {
  seen_.clear();
  first_row_ = findFirstRow(shift, least);
  for (int v = first_row_; v < size_.height; ++v) {
    const cv::Range seen = seenColumns(shift, least, v);
    if (seen_.empty() && seen.empty()) ++first_row_;
    if (!(seen_.empty() && seen.empty())) seen_.push_back(seen);
  }
  while (!seen_.empty() && seen_.back().empty()) seen_.pop_back();
}

void AlignedRows::begin(const cv::Mat& left, const ShiftModel& shift, double least) {
  findRows(shift, least);
  const int count = static_cast<int>(seen_.size());
  left_ = left_memory_.rowRange(0, count);
  left.rowRange(first_row_, first_row_ + count).convertTo(left_, CV_32F);
  for (int row = 0; row < count; ++row) fillUp(seen_[row], left_, row);
}

// Those of the columns seen by both cameras that can be read. These are all, unless the model is far from the
// first one.
cv::Range AlignedRows::readableColumns(const ShiftModel& shift, int row, int cols) const {
  const cv::Range& seen = seen_[row];
  const double density = 1 - shift.a, down = shift.b * (first_row_ + row) + shift.c;
  if (seen.empty() || !(density > kLeastDensity)) return {0, 0};
  // Interpolation reads one pixel before a place and two behind it.
  const cv::Range inside = between((1 + down) / density, (cols - 3 + down) / density, size_.width);
  return whole(std::max(seen.start, inside.start), std::min(seen.end, inside.end));
}

void AlignedRows::align(const cv::Mat& right, const ShiftModel& model) {
  right_ = right_memory_.rowRange(0, static_cast<int>(seen_.size()));
  for (int row = 0; row < right_.rows; ++row) {
    const int v = first_row_ + row;
    const ShiftModel shift = model.around(0.5 * size_.width, v);
    const cv::Range columns = readableColumns(shift, row, right.cols);
    if (!columns.empty()) {
      sampleParabolicRow(
          right.ptr<float>(v), ParabolicTable::fixed(columns.start - shift.at(columns.start, v)),
          ParabolicTable::fixed(1 - shift.a), columns.size(), right_.ptr<float>(row) + columns.start);
    }
    fillUp(columns, right_, row);
  }
}

}  // namespace uav_landing
