#pragma once

#include <Eigen/Core>
#include <cmath>

#include "uav_landing/lines/line_segments.h"

/// Straight lines through edges seen at single rows or columns of an image.
namespace uav_landing::line_fit {

/// Rows or columns looked at, roughly; a longer line skips some.
constexpr int kMaxStations = 160;

/// Where the edge is at one station: distances along and across the current line, px, and its gradient,
/// grey/px.
struct Peak {
  double along, across, gradient;
};

/// Of a value at each station; in the memory of the function that has it.
using Values = Eigen::Array<float, Eigen::Dynamic, 1, Eigen::ColMajor, 2 * kMaxStations, 1>;

/// The peaks along a line and their weights.
struct Peaks {
  int stations = 0;  ///< that were looked at
  Values along, across, gradient, weight;

  int size() const { return static_cast<int>(along.size()); }
  /// Keeps what is there.
  void resize(int size) {
    along.conservativeResize(size);
    across.conservativeResize(size);
    gradient.conservativeResize(size);
    weight.resize(size);
  }
  void set(int i, const Peak& peak) {
    along[i] = static_cast<float>(peak.along);
    across[i] = static_cast<float>(peak.across);
    gradient[i] = static_cast<float>(peak.gradient);
  }
};

/// Frame of a line: origin, direction along and (across) 90 degrees clockwise in the picture. Along points
/// down, or to the right when the line is flat, so that stations are whole rows or columns in rising order.
struct Axis {
  Eigen::Vector2d origin, along, across;
  int major, minor;  ///< image axis that the line runs along, and the other: 0 u, 1 v

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
struct Fit {
  float centre = 0, offset = 0, slope = 0, weight = 0, spread = 0;  // spread: sum w (along - centre)^2

  Values residuals(const Peaks& p) const { return p.across - offset - slope * (p.along - centre); }
};

/// Iteratively reweighted: the peak's variance falls with the gradient squared, and Tukey's biweight
/// removes stations at which something else was taken for the edge; their weight is 0 then. scale: robust
/// 1 sigma of the peaks about the line, px. There must be a peak.
Fit fitRobustly(Peaks& peaks, double& scale);

/// The same where the axis already is such a line, through fewer peaks: starts from that.
Fit refit(Peaks& peaks, double& scale);

/// The segment between the first and the last peak used. sign: +1 when it is brighter towards `across`.
LineSegment segmentOf(const Axis& axis, const Peaks& peaks, const Fit& fit, int sign);

}  // namespace uav_landing::line_fit
