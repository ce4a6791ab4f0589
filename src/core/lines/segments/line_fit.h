#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "kernels/edges/edge_peaks.h"
#include "kernels/lanes/lanes.h"
#include "kernels/samples/line_sums.h"
#include "lines/segments/line_segment.h"

/// Straight lines through edges that are seen at single rows or columns of an image.
namespace uav_landing::line_fit {

/// Rows or columns looked at, roughly; on a longer line some are skipped.
constexpr int kMaxStations = 160;

/// The edge at one station: distances along and across the current line, px, and its gradient, grey/px.
using Peak = EdgePeak;

/// A value per peak, filled up to whole lanes.
using Values = std::array<float, 2 * kMaxStations>;
static_assert(2 * kMaxStations % kLanes == 0 && 2 * kMaxStations <= kMostLineSamples, "whole lanes");

/// The peaks along a line and their weights.
struct Peaks {
  int stations = 0;  ///< number that was looked at
  int count = 0;
  alignas(sizeof(Lanes)) Values along, across, gradient, weight;

  void add(const Peak& peak) {
    along[count] = static_cast<float>(peak.along);
    across[count] = static_cast<float>(peak.across);
    gradient[count] = static_cast<float>(peak.gradient);
    ++count;
  }
  /// Fills the values of the peaks up to whole lanes with zeros.
  void pad() {
    for (int i = count; i < wholeLanes(count); ++i) along[i] = across[i] = gradient[i] = 0;
  }
  LineSamples samples() const { return {along.data(), across.data(), weight.data(), count}; }
  /// Number of peaks with a weight above zero.
  int used() const {
    int used = 0;
    for (int i = 0; i < count; ++i) used += weight[i] > 0 ? 1 : 0;
    return used;
  }
};

/// Frame of a line: origin, direction along, and direction across, 90 degrees clockwise in the image. `along`
/// points down, or to the right when the line is flat, so that stations are whole rows or columns in rising
/// order.
struct Axis {
  Eigen::Vector2d origin, along, across;
  int major, minor;  ///< image axis that the line runs along, and the other one: 0 u, 1 v

  Axis(const Eigen::Vector2d& point, const Eigen::Vector2d& direction)
      : origin(point), along(direction.normalized()) {
    major = std::abs(along.y()) >= std::abs(along.x()) ? 1 : 0;
    minor = 1 - major;
    if (along[major] < 0) along = -along;
    across = {-along.y(), along.x()};
  }
  Eigen::Vector2d point(double distance) const { return origin + distance * along; }
};

/// Weighted straight line across = offset + slope (along - centre).
using Fit = LineFit;

/// Iteratively reweighted fit. The variance of a peak falls with the square of its gradient. Tukey's biweight
/// gives the weight 0 to stations where something else was taken for the edge. scale: robust 1 sigma of the
/// peaks about the line, px. There must be a peak.
Fit fitRobustly(Peaks& peaks, double& scale);

/// The same when the axis already is a line through fewer of these peaks; the fit starts from it.
Fit refit(Peaks& peaks, double& scale);

/// The segment between the first and the last peak used. sign: +1 when it is brighter towards `across`.
LineSegment segmentOf(const Axis& axis, const Peaks& peaks, const Fit& fit, int sign);

}  // namespace uav_landing::line_fit
