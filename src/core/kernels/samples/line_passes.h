#pragma once

#include <cstddef>
#include <vector>

namespace uav_landing {

/// Pieces of straight lines in a plane, by columns.
struct LineColumns {
  std::vector<double> middle_u, middle_v;  ///< of the piece
  std::vector<double> along_u, along_v;    ///< unit vector along it
  std::vector<double> across_u, across_v;  ///< unit vector across it
  std::vector<double> top_u, top_v;        ///< the end with the smaller v
  std::vector<double> half2;               ///< half its length, squared
  std::vector<double> reach;               ///< distance from the middle within which a point is too near
  std::vector<double> tolerance2;          ///< squared distance

  void reserve(size_t count);
};

/// Stands for a line above the horizon, as a fit is 1 at most.
constexpr double kTopAbove = 2;

/// How well each of the first count lines passes through the homogeneous point (x, y, z).
///
/// The fit is 1 when the line passes exactly. It is 0 when its ends miss the line from its middle to the
/// point by the tolerance, and below 0 when they miss it by more. It is -1 when the point is too near. It is
/// kTopAbove when the top of the line lies above every line through the point that is no steeper than the
/// slope (rise over run).
void fitLines(const LineColumns& lines, double x, double y, double z, double slope, int count, double* fit);

}  // namespace uav_landing
