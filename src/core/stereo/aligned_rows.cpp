#include "stereo/aligned_rows.h"

#include <algorithm>
#include <cmath>

#include "image/parabolic_window.h"

namespace uav_landing {
namespace {

// Pixels that are interpolated at once.
constexpr int kTogether = 4;
// Right pixels over left ones, below which the ground is seen too much from the side.
constexpr double kLeastDensity = 0.2;

/// First and last pixel that are set, as a range; empty when none is.
cv::Range setColumns(const cv::Mat& mask, int v) {
  const uchar *begin = mask.ptr<uchar>(v), *end = begin + mask.cols;
  const uchar* first = std::find_if(begin, end, [](uchar value) { return value != 0; });
  while (end > first && end[-1] == 0) --end;
  return {static_cast<int>(first - begin), static_cast<int>(end - begin)};
}

/// Whole columns between two places, of 0 to cols.
cv::Range between(double begin, double end, int cols) {
  return {static_cast<int>(std::ceil(std::clamp<double>(begin, 0, cols))),
          static_cast<int>(std::floor(std::clamp<double>(end, 0, cols)))};
}

/// As many of them as can be interpolated together.
cv::Range whole(int begin, int end) {
  return end - begin < kTogether ? cv::Range(0, 0)
                                 : cv::Range(end - (end - begin) / kTogether * kTogether, end);
}

void fillUp(const cv::Range& known, cv::Mat& image, int row) {
  float* values = image.ptr<float>(row);
  if (known.empty()) {
    std::fill(values, values + image.cols, row > 0 ? image.at<float>(row - 1, 0) : 0.F);
    return;
  }
  std::fill(values, values + known.start, values[known.start]);
  std::fill(values + known.end, values + image.cols, values[known.end - 1]);
}

}  // namespace

AlignedRows::AlignedRows(cv::Mat left_mask, cv::Mat right_mask)
    : left_mask_(std::move(left_mask)), right_mask_(std::move(right_mask)) {}

// The highest row that may be ground, at either side.
int AlignedRows::findFirstRow(const ShiftModel& shift, double least) const {
  const auto horizon = [&](double u) { return (least - shift.c - shift.a * u) / shift.b; };
  const double highest = shift.b > 0 ? std::min(horizon(0), horizon(left_mask_.cols - 1)) : 0;
  return static_cast<int>(std::clamp<double>(std::ceil(highest), 0, left_mask_.rows));
}

cv::Range AlignedRows::seenColumns(const ShiftModel& shift, double least, int v) const {
  // Pixels that interpolation reads beside a place, and by which a later model may be off this one.
  constexpr int kAround = 5;
  const cv::Range left = setColumns(left_mask_, v), right = setColumns(right_mask_, v);
  const double density = 1 - shift.a, down = shift.b * v + shift.c;
  if (!(density > kLeastDensity) || right.size() <= 2 * kAround) return {0, 0};
  double begin = std::max<double>(left.start, (right.start + kAround + down) / density);
  double end = std::min<double>(left.end, (right.end - kAround + down) / density);
  // The horizon may cross the row.
  if (shift.a > 0) begin = std::max(begin, (least - down) / shift.a);
  if (shift.a < 0) end = std::min(end, (least - down) / shift.a);
  if (shift.a == 0 && down < least) return {0, 0};
  const cv::Range columns = between(begin, end, left_mask_.cols);
  return whole(columns.start, columns.end);
}

void AlignedRows::begin(const cv::Mat& left, const ShiftModel& shift, double least) {
  first_row_ = findFirstRow(shift, least);
  left_memory_.create(left.size(), CV_32F);
  left_ = left_memory_.rowRange(first_row_, left.rows);
  left.rowRange(first_row_, left.rows).convertTo(left_, CV_32F);
  seen_.clear();
  for (int v = 0; v < left_.rows; ++v) {
    seen_.push_back(seenColumns(shift, least, first_row_ + v));
    fillUp(seen_.back(), left_, v);
  }
}

// Of those that both cameras see: all, unless the model is far from the first one.
cv::Range AlignedRows::readableColumns(const ShiftModel& shift, int row, int cols) const {
  const cv::Range& seen = seen_[row];
  const double density = 1 - shift.a, down = shift.b * (first_row_ + row) + shift.c;
  if (seen.empty() || !(density > kLeastDensity)) return {0, 0};
  // One pixel before a place and two behind it.
  const cv::Range inside = between((1 + down) / density, (cols - 3 + down) / density, left_mask_.cols);
  return whole(std::max(seen.start, inside.start), std::min(seen.end, inside.end));
}

void AlignedRows::align(const cv::Mat& right, const ShiftModel& shift) {
  right_memory_.create(right.size(), CV_32F);
  right_ = right_memory_.rowRange(first_row_, right.rows);
  source_.resize(right.cols);
  for (int row = 0; row < right_.rows; ++row) {
    const int v = first_row_ + row;
    const cv::Range columns = readableColumns(shift, row, right.cols);
    if (!columns.empty()) {
      const uchar* pixels = right.ptr<uchar>(v);
      std::copy(pixels, pixels + right.cols, source_.begin());
      sampleParabolicRow(source_.data(), ParabolicTable::fixed(columns.start - shift.at(columns.start, v)),
                         ParabolicTable::fixed(1 - shift.a), columns.size(),
                         right_.ptr<float>(row) + columns.start);
    }
    fillUp(columns, right_, row);
  }
}

}  // namespace uav_landing
