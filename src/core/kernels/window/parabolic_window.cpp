#include "kernels/window/parabolic_window.h"

#include <algorithm>
#include <cmath>

#include "kernels/lanes/comparison.h"
#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

constexpr int kMostColumns = 56, kMostRows = 31;
constexpr int kBefore = 4;  // values before the first column of a row
// Default width of windows' rows in whole lanes. With it, the compiler needs no loop for a row.
constexpr int kUsual = 2 * kLanes;
// Largest number of lines, filled up so that whole registers can be used.
constexpr int kMostLines = (kMostRows + kLanes - 1) / kLanes * kLanes;

// Lines of places that are nearly along the rows, and where they cross the columns of pixels. The image is
// interpolated first along the columns, at all crossings of a line, and then along the line.
struct Crossings {
  // Column and row of the image where they begin; the row above is read, too.
  alignas(32) std::array<int, kMostLines> first, top;
  alignas(32) std::array<float, kMostLines> down;   // rows from top to the line at the first column
  alignas(32) std::array<float, kMostLines> start;  // columns from the first one to the first place
};

// Such lines, one per row of a window.
struct NearRows {
  Eigen::Vector2d begin, by_row;  // first place of the first row, and its change from row to row
  double step, slope, rise;       // columns between places; rows per column and over all columns
  int columns;

  NearRows(const Eigen::Vector2d& at, const Eigen::Matrix2d& warp, int radius, int stride)
      : begin(at - radius * (warp.col(0) + warp.col(1))),
        by_row(warp.col(1)),
        step(warp(0, 0)),
        slope(warp(1, 0) / step),
        columns(wholeLanes(static_cast<int>(1.999 + step * (stride - 1)) + 3)) {
    rise = slope * (columns - 1);
  }

  // All lines at once.
  [[gnu::always_inline]] inline void cross(int rows, Crossings& lines) const {
    const double x0 = begin.x(), y0 = begin.y(), x_by_row = by_row.x(), y_by_row = by_row.y();
    const double by_column = slope, falls = std::min(rise, 0.0);
    for (int j = 0; j < wholeLanes(rows); ++j) {
      const double x = x0 + x_by_row * j, y = y0 + y_by_row * j;
      const int first = static_cast<int>(x) - 1;
      const double behind = x - first, left = y - by_column * behind;
      const int top = static_cast<int>(left + falls);
      lines.first[j] = first;
      lines.start[j] = static_cast<float>(behind);
      lines.top[j] = top;
      lines.down[j] = static_cast<float>(left - top);
    }
  }

  // Whether all pixels that a line needs are inside the image, and it crosses at most two rows.
  bool fits(const cv::Mat& image, int row) const {
    const double x = begin.x() + by_row.x() * row, left = begin.y() + by_row.y() * row - 2 * std::abs(slope);
    return x >= 1 && x + columns <= image.cols && left + std::min(rise, 0.0) >= 1 &&
           left + 4 * std::abs(slope) + std::max(rise, 0.0) + 4 < image.rows && std::abs(rise) < 0.999;
  }
};

// The image at the crossings of a line. p: first pixel in the row above.
[[gnu::always_inline]] inline void interpolateDown(const float* p, std::ptrdiff_t stride, float down,
                                                   float slope, int columns, float* out) {
  const bool between_two_rows = down + std::max(slope, 0.f) * static_cast<float>(columns) < 0.999f;
  Lanes t, values;
  progress(down, slope, t);
  if (between_two_rows) {
    for (int i = 0; i < columns; i += kLanes, p += kLanes, t += kLanes * slope) {
      parabolicBetween({p, p + stride, p + 2 * stride, p + 3 * stride}, t, values);
      store(values, out + i);
    }
  } else {
    for (int i = 0; i < columns; i += kLanes, p += kLanes, t += kLanes * slope) {
      parabolicBetween({p, p + stride, p + 2 * stride, p + 3 * stride, p + 4 * stride}, t, values);
      store(values, out + i);
    }
  }
}

// Whether kLanes consecutive places lie in consecutive columns, except that from one of them on they may be
// one column further or still in the same one.
bool inNeighbouringColumns(double step) { return std::abs(step - 1) * (kLanes - 1) < 0.99; }

// Values at start, start + step, ..., for such places, row by row. The first place of each group of kLanes is
// found for all rows together.
class AlongRows {
 public:
  // start: of each row, columns. rows: of the arrays, filled up to whole lanes.
  [[gnu::always_inline]] inline void find(const std::array<float, kMostLines>& starts, int rows, float step,
                                          int count) {
    drift_ = step - 1;
    for (int j = 0; j < wholeLanes(rows); j += kLanes) {
      Lanes start;
      load(&starts[j], start);
      for (int i = 0; i < count; i += kLanes, start += step * kLanes) {
        Begin& begin = begins_[i / kLanes];
        const Lanes last = start + drift_ * (kLanes - 1);
        IntLanes first;
        Lanes before;
        smaller(last, start, before);
        truncate(before, first);
        convert(first, before);
        store(first, &begin.first[j]);
        store(start - before, &begin.behind[j]);
      }
    }
  }

  // row: the j-th one, from the column that places are counted from.
  [[gnu::always_inline]] inline void interpolate(const float* row, int j, int count,
                                                 float* __restrict out) const {
    for (int i = 0; i < count; i += kLanes) {
      const Begin& begin = begins_[i / kLanes];
      const float* p = row + begin.first[j] - 1;
      Lanes t, values;
      progress(begin.behind[j], drift_, t);
      parabolicBetween({p, p + 1, p + 2, p + 3, p + 4}, t, values);
      store(values, out + i);
    }
  }

 private:
  struct Begin {
    alignas(32) std::array<int, kMostLines> first;     // column in front of the places
    alignas(32) std::array<float, kMostLines> behind;  // columns from there to the first place
  };
  float drift_;
  std::array<Begin, kMostColumns / kLanes> begins_;
};

// Places in rows of the image, each in a column after the one before. Row j begins at start + j by_row.
struct PlaceRows {
  double start, by_row,
      drift;  // drift: columns by which the last place is ahead of consecutive columns

  bool inside(const cv::Mat& image, int rows, int count) const {
    const double last = start + by_row * (rows - 1);
    return std::min(start, last) + std::min(drift, 0.0) >= 1 &&
           std::max(start, last) + std::max(drift, 0.0) + count + 3 < image.cols;
  }
  // Columns from which the places are counted, and the first place from there.
  [[gnu::always_inline]] inline void find(int rows, std::array<int, kMostLines>& columns,
                                          std::array<float, kMostLines>& starts) const {
    const double first_place = start, step = by_row, back = std::min(drift, 0.0);
    for (int j = 0; j < wholeLanes(rows); ++j) {
      const double x = first_place + step * j;
      columns[j] = static_cast<int>(x + back);
      starts[j] = static_cast<float>(x - columns[j]);
    }
  }
};

UAV_LANDING_MULTIVERSION bool sampleNeighbours(const cv::Mat& image, int v, double start, double by_row,
                                               double step, int rows, int stride, float* out) {
  const int count = wholeLanes(stride);
  const PlaceRows places{start, by_row, (step - 1) * (count - 1)};
  if (!inNeighbouringColumns(step) || rows > kMostRows || count > kMostColumns ||
      !places.inside(image, rows, count)) {
    return false;
  }
  alignas(32) std::array<int, kMostLines> columns;
  alignas(32) std::array<float, kMostLines> starts;
  places.find(rows, columns, starts);
  const float* row = image.ptr<float>(v);
  AlongRows along;
  if (count == kUsual) {
    along.find(starts, rows, static_cast<float>(step), kUsual);
    for (int j = 0; j < rows; ++j, out += stride, row += rowStride(image))
      along.interpolate(row + columns[j], j, kUsual, out);
  } else {
    along.find(starts, rows, static_cast<float>(step), count);
    for (int j = 0; j < rows; ++j, out += stride, row += rowStride(image))
      along.interpolate(row + columns[j], j, count, out);
  }
  return true;
}

struct LineValues {
  std::array<float, kMostColumns * kMostRows> values;
  float* row(int j) { return &values[j * kMostColumns + kBefore]; }
};

// The image at all crossings. All rows are written before any is read again, because values written in pieces
// are not available at once.
[[gnu::always_inline]] inline void interpolateDown(const cv::Mat& image, const Crossings& lines, float slope,
                                                   int rows, int columns, LineValues& values) {
  const std::ptrdiff_t stride = rowStride(image);
  const float* origin = image.ptr<float>();
  for (int j = 0; j < rows; ++j) {
    float* row = values.row(j);
    interpolateDown(origin + (lines.top[j] - 1) * stride + lines.first[j], stride, lines.down[j], slope,
                    columns, row);
    row[-1] = row[columns] = 0;  // are read, but not chosen
  }
}

UAV_LANDING_MULTIVERSION bool sampleNearRows(const cv::Mat& image, const Eigen::Vector2d& at,
                                             const Eigen::Matrix2d& warp, int radius, int stride,
                                             float* out) {
  if (!(warp(0, 0) > 0.1 && warp(0, 0) * stride < kMostColumns - kLanes - 6) || 2 * radius + 1 > kMostRows)
    return false;
  const NearRows near(at, warp, radius, stride);
  const int size = 2 * radius + 1;
  if (!near.fits(image, 0) || !near.fits(image, size - 1)) return false;
  Crossings lines;
  near.cross(size, lines);
  LineValues values;
  const float slope = static_cast<float>(near.slope), step = static_cast<float>(near.step);
  if (near.columns == kUsual) {
    interpolateDown(image, lines, slope, size, kUsual, values);
  } else {
    interpolateDown(image, lines, slope, size, near.columns, values);
  }
  if (!inNeighbouringColumns(near.step)) {
    const std::int32_t fixed_step = ParabolicTable::fixed(near.step);
    for (int j = 0; j < size; ++j, out += stride)
      sampleParabolicRow(values.row(j), ParabolicTable::fixed(lines.start[j]), fixed_step, stride, out);
    return true;
  }
  AlongRows along;
  const int count = wholeLanes(stride);
  if (count == kUsual) {
    along.find(lines.start, size, step, kUsual);
    for (int j = 0; j < size; ++j, out += stride) along.interpolate(values.row(j), j, kUsual, out);
  } else {
    along.find(lines.start, size, step, count);
    for (int j = 0; j < size; ++j, out += stride) along.interpolate(values.row(j), j, count, out);
  }
  return true;
}

}  // namespace

void sampleParabolicWindow(const cv::Mat& image, const Eigen::Vector2d& at, const Eigen::Matrix2d& warp,
                           int radius, int stride, float* out) {
  if (sampleNearRows(image, at, warp, radius, stride, out)) return;
  const std::int32_t step_x = ParabolicTable::fixed(warp(0, 0)), step_y = ParabolicTable::fixed(warp(1, 0));
  for (int dy = -radius; dy <= radius; ++dy, out += stride) {
    const Eigen::Vector2d start = at + warp * Eigen::Vector2d(-radius, dy);
    sampleParabolicLine(image, ParabolicTable::fixed(start.x()), ParabolicTable::fixed(start.y()), step_x,
                        step_y, stride, out);
  }
}

void sampleParabolicRows(const cv::Mat& image, int v, double start, double by_row, double step, int rows,
                         int stride, float* out) {
  if (sampleNeighbours(image, v, start, by_row, step, rows, stride, out)) return;
  const std::int32_t fixed_step = ParabolicTable::fixed(step);
  for (int j = 0; j < rows; ++j)
    sampleParabolicRow(image.ptr<float>(v + j), ParabolicTable::fixed(start + by_row * j), fixed_step, stride,
                       out + j * stride);
}

}  // namespace uav_landing
