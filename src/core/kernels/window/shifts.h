#pragma once

#include <array>
#include <vector>

#include "kernels/lanes/lanes.h"
#include "kernels/window/strip.h"

namespace uav_landing {

/// Memory for sums over the rows of the windows at neighbouring shifts.
struct ShiftRows {
  struct Sums {
    alignas(32) std::array<float, kLanes> values, squares;
  };
  std::vector<Sums> rows;
};

/// Correlation of a window with an area at all whole shifts, row by row: count in each direction. At the
/// first shift, the window's first pixel is the area's. 1 when they differ by gain and offset only. kNoScore
/// when the area has less than a thousandth of the window's energy. stride: from row to row of the area,
/// which has room for whole lanes of shifts.
void correlateShifts(const CentredWindow& window, const float* area, int stride, int count, ShiftRows& memory,
                     float* scores);

}  // namespace uav_landing
