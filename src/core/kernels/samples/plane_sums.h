#pragma once

#include <cstddef>
#include <vector>

#include "kernels/samples/plane_votes.h"

namespace uav_landing {

/// Samples of a value that is linear in x and y, by columns, filled up to whole lanes with samples of no
/// precision. precision: 1 / standard deviation.
struct PlaneColumns {
  std::vector<double> x, y, value, precision;
  std::vector<double> expected, weight, ratio;  ///< results of the functions below

  /// For so many samples, in the memory of those before.
  void resize(size_t count);
};

/// Sets the values that a plane gives.
void expectValues(const LinearValue& plane, PlaneColumns& columns);

/// Samples that have a precision and are no larger than expected, but not farther below than something.
struct NearbyCount {
  size_t all;
  size_t small;  ///< those of them that are not farther off than a share of their standard deviation
};

/// Counts them, and sets the ratios of their residuals to their standard deviations, of other samples to
/// infinity. farthest: > 0; per_ratio: 1 / the share. After expectValues().
NearbyCount measureBelow(double farthest, double per_ratio, PlaneColumns& columns);

/// Sums over samples by their weights w; d: the value. count: of those with a weight.
struct PlaneSums {
  double w, wx, wy, wxx, wxy, wyy, wd, wxd, wyd, squares;  ///< squares: w residual^2
  int count;
};

/// Sets Tukey's weights, (1 - unit residual^2 / variance)^2 / variance or 0, and adds up. Samples with an
/// expected value of 0 or less have none. After expectValues().
PlaneSums addUpTukey(double unit, PlaneColumns& columns);

}  // namespace uav_landing
