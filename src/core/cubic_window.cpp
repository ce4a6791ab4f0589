#include "cubic_window.h"

#include <algorithm>
#include <cmath>

#include "lanes.h"
#include "multiversion.h"

namespace uav_landing {
namespace {

constexpr int kMostColumns = 56, kMostRows = 31;
constexpr int kBefore = 4;  // values before the first column of a row

// A line of places that is nearly along the rows, by the pixels' columns that it crosses: between them along
// the columns first, all columns at a time, and then along the line.
struct Crossings {
  int first, top;  // column and row of the image where they begin; the row above is read, too
  float down;      // rows from top to the line at the first column
  float start;     // columns from the first one to the first place
};

// Such lines, one for each row of a window.
struct NearRows {
  Eigen::Vector2d begin, by_row;  // first place of the first row, and what it moves by from row to row
  double step, slope, rise;       // columns between places, rows by column and over all columns
  int columns;

  NearRows(const Eigen::Vector2d& at, const Eigen::Matrix2d& warp, int radius, int stride)
      : begin(at - radius * (warp.col(0) + warp.col(1))),
        by_row(warp.col(1)),
        step(warp(0, 0)),
        slope(warp(1, 0) / step),
        columns(wholeLanes(static_cast<int>(1.999 + step * (stride - 1)) + 3)) {
    rise = slope * (columns - 1);
  }

  Crossings at(int row) const {
    Crossings line;
    const double x = begin.x() + by_row.x() * row, y = begin.y() + by_row.y() * row;
    line.first = static_cast<int>(x) - 1;
    line.start = static_cast<float>(x - line.first);
    const double left = y - slope * (x - line.first);
    line.top = static_cast<int>(std::min(left, left + rise));
    line.down = static_cast<float>(left - line.top);
    return line;
  }

  // Whether a line has all it needs inside the image and crosses at most two of its rows.
  bool fits(const cv::Mat& image, int row) const {
    const double x = begin.x() + by_row.x() * row, left = begin.y() + by_row.y() * row - 2 * std::abs(slope);
    return x >= 1 && x + columns <= image.cols && left + std::min(rise, 0.0) >= 1 &&
           left + 4 * std::abs(slope) + std::max(rise, 0.0) + 4 < image.rows && std::abs(rise) < 0.999;
  }
};

// The image at the crossings.
[[gnu::always_inline]] inline void interpolateDown(const float* image, std::ptrdiff_t stride,
                                                   const Crossings& line, float slope, int columns,
                                                   float* out) {
  const float* p = image + (line.top - 1) * stride + line.first;
  Lanes t, values;
  progress(line.down, slope, t);
  for (int i = 0; i < columns; i += kLanes, p += kLanes, t += kLanes * slope) {
    cubicBetween({p, p + stride, p + 2 * stride, p + 3 * stride, p + 4 * stride}, t, values);
    store(values, out + i);
  }
}

// Whether of kLanes places by this step each is in the next column or, from one of them on, in the one after
// that or still the same.
bool inNeighbouringColumns(double step) { return std::abs(step - 1) * (kLanes - 1) < 0.99; }

// Values at start, start + step, ... of such places.
[[gnu::always_inline]] inline void interpolateAlong(const float* row, float start, float step, int count,
                                                    float* __restrict out) {
  const float drift = step - 1;
  for (int i = 0; i < count; i += kLanes, start += step * kLanes) {
    const int first = static_cast<int>(std::min(start, start + drift * (kLanes - 1)));
    const float* p = row + first - 1;
    Lanes t, values;
    progress(start - static_cast<float>(first), drift, t);
    cubicBetween({p, p + 1, p + 2, p + 3, p + 4}, t, values);
    store(values, out + i);
  }
}

UAV_LANDING_MULTIVERSION bool sampleNeighbours(const cv::Mat& image, int v, double start, double by_row,
                                               double step, int rows, int stride, float* out) {
  const int count = wholeLanes(stride);
  const double last = start + by_row * (rows - 1), drift = (step - 1) * (count - 1);
  if (!inNeighbouringColumns(step) || !(std::min(start, last) + std::min(drift, 0.0) >= 1) ||
      !(std::max(start, last) + std::max(drift, 0.0) + count + 3 < image.cols)) {
    return false;
  }
  for (int j = 0; j < rows; ++j, out += stride) {
    const double x = start + by_row * j;
    const int first = static_cast<int>(x + std::min(drift, 0.0));
    interpolateAlong(image.ptr<float>(v + j) + first, static_cast<float>(x - first), static_cast<float>(step),
                     count, out);
  }
  return true;
}

UAV_LANDING_MULTIVERSION bool sampleNearRows(const cv::Mat& image, const Eigen::Vector2d& at,
                                             const Eigen::Matrix2d& warp, int radius, int stride,
                                             float* out) {
  if (!(warp(0, 0) > 0.1 && warp(0, 0) * stride < kMostColumns - kLanes - 6) || 2 * radius + 1 > kMostRows)
    return false;
  const NearRows lines(at, warp, radius, stride);
  const int size = 2 * radius + 1, columns = lines.columns;
  if (!lines.fits(image, 0) || !lines.fits(image, size - 1)) return false;
  std::array<float, kMostColumns * kMostRows> values;
  std::array<float, kMostRows> starts;
  const float slope = static_cast<float>(lines.slope);
  const std::ptrdiff_t image_stride = static_cast<std::ptrdiff_t>(image.step1());
  // All rows before any is read again: what was just written piece by piece is not yet there to be read.
  for (int j = 0; j < size; ++j) {
    const Crossings line = lines.at(j);
    starts[j] = line.start;
    float* row = &values[j * kMostColumns + kBefore];
    interpolateDown(image.ptr<float>(), image_stride, line, slope, columns, row);
    row[-1] = row[columns] = 0;  // are read, but not chosen
  }
  const bool neighbours = inNeighbouringColumns(lines.step);
  const float step = static_cast<float>(lines.step);
  const std::int32_t fixed_step = CubicTable::fixed(lines.step);
  for (int j = 0; j < size; ++j, out += stride) {
    const float* row = &values[j * kMostColumns + kBefore];
    if (neighbours) {
      interpolateAlong(row, starts[j], step, wholeLanes(stride), out);
    } else {
      sampleCubicRow(row, CubicTable::fixed(starts[j]), fixed_step, stride, out);
    }
  }
  return true;
}

}  // namespace

void sampleCubicWindow(const cv::Mat& image, const Eigen::Vector2d& at, const Eigen::Matrix2d& warp,
                       int radius, int stride, float* out) {
  if (sampleNearRows(image, at, warp, radius, stride, out)) return;
  const std::int32_t step_x = CubicTable::fixed(warp(0, 0)), step_y = CubicTable::fixed(warp(1, 0));
  for (int dy = -radius; dy <= radius; ++dy, out += stride) {
    const Eigen::Vector2d start = at + warp * Eigen::Vector2d(-radius, dy);
    sampleCubicLine(image, CubicTable::fixed(start.x()), CubicTable::fixed(start.y()), step_x, step_y, stride,
                    out);
  }
}

void sampleCubicRows(const cv::Mat& image, int v, double start, double by_row, double step, int rows,
                     int stride, float* out) {
  if (sampleNeighbours(image, v, start, by_row, step, rows, stride, out)) return;
  const std::int32_t fixed_step = CubicTable::fixed(step);
  for (int j = 0; j < rows; ++j)
    sampleCubicRow(image.ptr<float>(v + j), CubicTable::fixed(start + by_row * j), fixed_step, stride,
                   out + j * stride);
}

}  // namespace uav_landing
