#pragma once

#include <cstddef>
#include <vector>

#include "kernels/samples/plane_votes.h"

namespace uav_landing {

/// Samples of a value that is linear in x and y, by columns, filled up to whole lanes with samples of
/// precision 0. precision: 1 / standard deviation.
struct PlaneColumns {
  std::vector<double> x, y, value, precision;
  std::vector<double> expected, weight, ratio;  ///< results of the functions below

  /// Makes room for so many samples, in the memory of those before.
  void resize(size_t count);
};

/// Sets the values that a plane predicts.
void expectValues(const LinearValue& plane, PlaneColumns& columns);

/// Numbers of samples near a plane: they have a precision, are at most as large as expected, and are not too
/// far below.
struct NearbyCount {
  size_t all;
  size_t small;  ///< those that are off by at most a share of their standard deviation
};

/// Counts the samples, and sets the ratios of their residuals to their standard deviations; those of other
/// samples are infinity. farthest: largest distance below, > 0. per_ratio: 1 / the share. Call it after
/// expectValues().
NearbyCount measureBelow(double farthest, double per_ratio, PlaneColumns& columns);

/// Sums over samples by their weights w. d: the value. count: of samples with a weight.
struct PlaneSums {
  double w, wx, wy, wxx, wxy, wyy, wd, wxd, wyd, squares;  ///< squares: w residual^2
  int count;
};

/// Sets Tukey's weights, (1 - unit residual^2 / variance)^2 / variance or 0, and sums up. Samples with an
/// expected value of 0 or less have no weight. Call it after expectValues().
PlaneSums addUpTukey(double unit, PlaneColumns& columns);

}  // namespace uav_landing
