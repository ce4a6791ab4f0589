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

/// Sets 1 for numbers whose squared difference from one of them is larger than limit times the variance of
/// the difference, and 0 for the others. That variance is the sum of both, and by_change times the square of
/// how far their derivatives are apart.
void markApart(const NumberColumns& numbers, std::ptrdiff_t one, float limit, float by_change, uchar* apart);

}  // namespace uav_landing
