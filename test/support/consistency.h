#pragma once

#include <cmath>

namespace uav_landing {
namespace test {

/// Half-width of the 99.9 % interval of the mean of `count` independent chi-square values with `dof` degrees
/// of freedom: what a Monte Carlo test of a true covariance may be off by chance.
inline double chiSquareMeanTolerance(int count, int dof) { return 3.29 * std::sqrt(2.0 * dof / count); }

}  // namespace test
}  // namespace uav_landing
