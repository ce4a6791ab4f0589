#pragma once

#include <cstddef>
#include <vector>

namespace uav_landing {

/// Pieces of straight lines in a plane, by columns.
struct LineColumns {
  std::vector<double> middle_u, middle_v;  ///< of the piece
  std::vector<double> along_u, along_v;    ///< unit vector along it
  std::vector<double> across_u, across_v;  ///< and across
  std::vector<double> top_u, top_v;        ///< the end of smaller v
  std::vector<double> half2;               ///< half its length, squared
  std::vector<double> reach;               ///< from the middle, within which a point is too near
  std::vector<double> tolerance2;          ///< squared distance

  void reserve(size_t count);
};

/// Instead of a fit, which is 1 at most.
constexpr double kTopAbove = 2;

/// How well each of the first count lines passes through the homogeneous point (x, y, z): 1 when exactly, 0
/// when its ends miss the line from its middle to the point by the tolerance, below that when they miss it by
/// more, -1 when the point is too near; kTopAbove when its top is above both lines of this slope (rise over
/// run, falling to both sides) through the point.
void fitLines(const LineColumns& lines, double x, double y, double z, double slope, int count, double* fit);

}  // namespace uav_landing
