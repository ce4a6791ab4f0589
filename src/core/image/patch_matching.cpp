#include "image/patch_matching.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"
#include "kernels/window/parabolic_window.h"
#include "kernels/window/window_layout.h"

namespace uav_landing {
namespace {

// Over one row of the windows of kLanes neighbouring shifts.
struct RowSums {
  alignas(32) std::array<float, kLanes> values, squares;
};

// What the scores of kLanes neighbouring shifts are made of: products with the window, sums and squares.
struct ShiftSums {
  alignas(32) std::array<float, kLanes> cross, sums, squares;
};

// area: values of the other image, whose first pixel is the first shift's.
[[gnu::always_inline]] inline void addRowsAny(const float* area, int size, int stride, int rows,
                                              RowSums* sums) {
  for (int j = 0; j < rows; ++j, area += stride) {
    Lanes row_sums{}, row_squares{};
    for (int i = 0; i < size; ++i) {
      Lanes values;
      load(area + i, values);
      row_sums += values;
      row_squares += values * values;
    }
    store(row_sums, sums[j].values.data());
    store(row_squares, sums[j].squares.data());
  }
}

// window: without its mean. rows: of the area.
[[gnu::always_inline]] inline void addUpAny(const float* window, const float* area, const RowSums* rows,
                                            int size, int stride, ShiftSums& shifts) {
  Lanes cross{}, sums{}, squares{};
  for (int j = 0; j < size; ++j, area += stride) {
    Lanes row_cross{}, row_sums, row_squares;  // of their own, so that rows need not wait for each other
    for (int i = 0; i < size; ++i) {
      Lanes values;
      load(area + i, values);
      row_cross += *window++ * values;
    }
    load(rows[j].values.data(), row_sums);
    load(rows[j].squares.data(), row_squares);
    cross += row_cross;
    sums += row_sums;
    squares += row_squares;
  }
  store(cross, shifts.cross.data());
  store(sums, shifts.sums.data());
  store(squares, shifts.squares.data());
}

// The usual size is known to the compiler, which then needs no loop for a row.
UAV_LANDING_MULTIVERSION void addRows(const float* area, int size, int stride, int rows, RowSums* sums) {
  if (size == kUsualWindowSize) {
    addRowsAny(area, kUsualWindowSize, stride, rows, sums);
  } else {
    addRowsAny(area, size, stride, rows, sums);
  }
}

UAV_LANDING_MULTIVERSION void addUp(const float* window, const float* area, const RowSums* rows, int size,
                                    int stride, ShiftSums& shifts) {
  if (size == kUsualWindowSize) {
    addUpAny(window, area, rows, kUsualWindowSize, stride, shifts);
  } else {
    addUpAny(window, area, rows, size, stride, shifts);
  }
}

UAV_LANDING_MULTIVERSION void subtract(float mean, std::vector<float>& values) {
  for (float& value : values) value -= mean;
}

}  // namespace

PatchSearch::PatchSearch(const cv::Mat& reference, const cv::Mat& other, int radius)
    : reference_(reference), other_(other), radius_(radius) {}

bool PatchSearch::sample(const Eigen::Vector2d& centre, const Eigen::Matrix2d& warp, int steps) {
  const int reach = radius_ + steps, rows = 2 * reach + 1;
  stride_ = (wholeLanes(2 * steps + 1) + 2 * radius_ + 3) / 4 * 4;
  const int padded_reach = stride_ - reach - 1;
  const double rx = std::abs(warp(0, 0)) * padded_reach + std::abs(warp(0, 1)) * reach;
  const double ry = std::abs(warp(1, 0)) * padded_reach + std::abs(warp(1, 1)) * reach;
  if (!(centre.x() - rx >= 2 && centre.y() - ry >= 2 && centre.x() + rx < other_.cols - 3 &&
        centre.y() + ry < other_.rows - 3)) {
    return false;
  }
  area_.resize(wholeLanes(stride_ * rows) + kLanes);
  sampleParabolicWindow(other_, centre, warp, reach, stride_, area_.data());
  // Less about the mean, so that floats are exact enough for the differences of sums.
  subtract(static_cast<float>(template_.mean), area_);
  return true;
}

void PatchSearch::score(int steps) {
  const int size = 2 * radius_ + 1, count = 2 * steps + 1;
  scores_.assign(static_cast<size_t>(count) * count, -1.f);
  static thread_local std::vector<RowSums> rows;  // kept for its memory
  rows.resize(size + 2 * steps);
  ShiftSums shifts;
  for (int first = 0; first < count; first += kLanes) {
    const float* area = area_.data() + first;
    addRows(area, size, stride_, size + 2 * steps, rows.data());
    for (int j = 0; j < count; ++j, area += stride_) {
      addUp(template_.values.data(), area, &rows[j], size, stride_, shifts);
      for (int k = 0; k < std::min(kLanes, count - first); ++k) {
        const double sum = shifts.sums[k], energy = shifts.squares[k] - sum * sum / (double(size) * size);
        if (energy < 1e-3 * template_.energy) continue;
        scores_[static_cast<size_t>(j) * count + first + k] =
            static_cast<float>(shifts.cross[k] / std::sqrt(energy * template_.energy));
      }
    }
  }
}

PatchSearch::Best PatchSearch::run(int u, int v, const Eigen::Vector2d& centre, const Eigen::Matrix2d& warp,
                                   int steps) {
  Best best;
  if (!template_.load(reference_, u, v, radius_) || !sample(centre, warp, steps)) return best;
  score(steps);
  const int count = 2 * steps + 1;
  const int index = static_cast<int>(std::max_element(scores_.begin(), scores_.end()) - scores_.begin());
  const int bi = index % count, bj = index / count;
  best.score = scores_[index];
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      if (std::abs(i - bi) <= 2 && std::abs(j - bj) <= 2) continue;
      best.second = std::max<double>(best.second, scores_[static_cast<size_t>(j) * count + i]);
    }
  }
  best.position = centre + warp * Eigen::Vector2d(bi - steps, bj - steps);
  best.found = bi > 0 && bj > 0 && bi + 1 < count && bj + 1 < count && best.score > 0;
  return best;
}

}  // namespace uav_landing
