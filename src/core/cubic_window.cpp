#include "cubic_window.h"

#include <algorithm>
#include <cmath>

#include "lanes.h"
#include "multiversion.h"

namespace uav_landing {
namespace {

constexpr int kMostColumns = 56, kMostRows = 31;

// A line of places that is nearly along the rows, by the pixels' columns that it crosses: between them along
// the columns first, all columns at a time, and then along the line.
struct Crossings {
  int first, top;     // column and row of the image where they begin; the row above is read, too
  float down, slope;  // rows from top to the line at the first column, and by column
  double start;       // columns from the first one to the first place
};

// False when the line is too steep or too near the image's border for that.
bool cross(const cv::Mat& image, double x, double y, const Eigen::Vector2d& step, int count, int columns,
           Crossings& line) {
  line.first = std::min(static_cast<int>(x) - 1, image.cols - columns);
  if (line.first < 0) return false;
  line.start = x - line.first;
  const double slope = step.y() / step.x(), start = y - slope * line.start;
  const double end = start + slope * (columns - 1);
  line.top = static_cast<int>(std::min(start, end));
  line.down = static_cast<float>(start - line.top);
  line.slope = static_cast<float>(slope);
  const double last = line.start + step.x() * (count - 1) + 2;
  return std::min(start, end) >= 1 && line.top + 3 < image.rows && std::max(start, end) - line.top < 1.999 &&
         last < columns;
}

// The image at the crossings.
inline void interpolateDown(const cv::Mat& image, const Crossings& line, int columns, float* __restrict out) {
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(image.step1());
  const float* p = image.ptr<float>(line.top - 1) + line.first;
  const float down = line.down, slope = line.slope;
  const float *p0 = p, *p1 = p + stride, *p2 = p + 2 * stride, *p3 = p + 3 * stride, *p4 = p + 4 * stride;
  for (int i = 0; i < columns; ++i) {
    const float below = down + slope * static_cast<float>(i);
    // Behind the next row: 1, else 0. Arithmetic instead of a choice, so that no branch keeps columns apart.
    const float next = static_cast<float>(static_cast<int>(below));
    const float t = below - next, a0 = p0[i], a1 = p1[i], a2 = p2[i], a3 = p3[i], a4 = p4[i];
    out[i] = cubicBetween(a0 + next * (a1 - a0), a1 + next * (a2 - a1), a2 + next * (a3 - a2),
                          a3 + next * (a4 - a3), t);
  }
}

UAV_LANDING_MULTIVERSION bool sampleNearRows(const cv::Mat& image, const Eigen::Vector2d& at,
                                             const Eigen::Matrix2d& warp, int radius, int stride,
                                             float* out) {
  const Eigen::Vector2d step = warp.col(0);
  if (!(step.x() > 0.1 && step.x() * stride < kMostColumns - kLanes - 4) || 2 * radius + 1 > kMostRows)
    return false;
  const int needed = static_cast<int>(step.x() * (stride - 1)) + 5;
  const int columns = wholeLanes(needed);
  std::array<float, kMostColumns * kMostRows> values;
  std::array<double, kMostRows> starts;
  // All rows before any is read again: what was just written piece by piece is not yet there to be read.
  for (int j = 0; j < 2 * radius + 1; ++j) {
    Crossings line;
    const Eigen::Vector2d place = at + warp * Eigen::Vector2d(-radius, j - radius);
    if (!cross(image, place.x(), place.y(), step, stride, columns, line)) return false;
    starts[j] = line.start;
    interpolateDown(image, line, columns, &values[j * kMostColumns]);
  }
  const std::int32_t fixed_step = CubicTable::fixed(step.x());
  for (int j = 0; j < 2 * radius + 1; ++j)
    sampleCubicRow(&values[j * kMostColumns], CubicTable::fixed(starts[j]), fixed_step, stride,
                   out + j * stride);
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

}  // namespace uav_landing
