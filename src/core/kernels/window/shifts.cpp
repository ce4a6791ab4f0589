#include "kernels/window/shifts.h"

#include <algorithm>
#include <cmath>

#include "kernels/lanes/multiversion.h"
#include "kernels/window/window_layout.h"

namespace uav_landing {
namespace {

// Sums from which the scores of kLanes neighbouring shifts follow: products with the window, values and
// squares.
struct ShiftSums {
  alignas(32) std::array<float, kLanes> cross, sums, squares;
};

// area: values of the other image, whose first pixel belongs to the first shift.
[[gnu::always_inline]] inline void addRowsAny(const float* area, int size, int stride, int rows,
                                              ShiftRows::Sums* sums) {
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

// window: without its mean. rows: sums over the area's rows.
[[gnu::always_inline]] inline void addUpAny(const float* window, const float* area,
                                            const ShiftRows::Sums* rows, int size, int stride,
                                            ShiftSums& shifts) {
  Lanes cross{}, sums{}, squares{};
  for (int j = 0; j < size; ++j, area += stride) {
    Lanes row_cross{}, row_sums, row_squares;  // separate sums, so that rows need not wait for each other
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
UAV_LANDING_MULTIVERSION void addRows(const float* area, int size, int stride, int rows,
                                      ShiftRows::Sums* sums) {
  if (size == kUsualWindowSize) {
    addRowsAny(area, kUsualWindowSize, stride, rows, sums);
  } else {
    addRowsAny(area, size, stride, rows, sums);
  }
}

UAV_LANDING_MULTIVERSION void addUp(const float* window, const float* area, const ShiftRows::Sums* rows,
                                    int size, int stride, ShiftSums& shifts) {
  if (size == kUsualWindowSize) {
    addUpAny(window, area, rows, kUsualWindowSize, stride, shifts);
  } else {
    addUpAny(window, area, rows, size, stride, shifts);
  }
}

}  // namespace

void correlateShifts(const CentredWindow& window, const float* area, int stride, int count, ShiftRows& memory,
                     float* scores) {
  const int size = window.size, rows = size + count - 1;
  const double pixels = double(size) * size;
  std::fill_n(scores, static_cast<size_t>(count) * count, kNoScore);
  memory.rows.resize(rows);
  ShiftSums shifts;
  for (int first = 0; first < count; first += kLanes) {
    const float* from = area + first;
    addRows(from, size, stride, rows, memory.rows.data());
    for (int j = 0; j < count; ++j, from += stride) {
      addUp(window.values, from, &memory.rows[j], size, stride, shifts);
      for (int k = 0; k < std::min(kLanes, count - first); ++k) {
        const double sum = shifts.sums[k], energy = shifts.squares[k] - sum * sum / pixels;
        if (energy < 1e-3 * window.energy) continue;
        scores[static_cast<size_t>(j) * count + first + k] =
            static_cast<float>(shifts.cross[k] / std::sqrt(energy * window.energy));
      }
    }
  }
}

}  // namespace uav_landing
