#pragma once

#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Numbers with their variances and a vector of derivatives each, by columns.
struct NumberColumns {
  const float *values, *variances;
  std::array<const float*, 3> derivatives;
  int count;
};

/// Sets 1 for numbers that are apart from one of them, else 0. Apart means that the squared difference
/// exceeds limit times its variance. That variance is the sum of both variances, plus by_change times the
/// squared distance of their derivatives.
void markApart(const NumberColumns& numbers, std::ptrdiff_t one, float limit, float by_change, uchar* apart);

}  // namespace uav_landing
