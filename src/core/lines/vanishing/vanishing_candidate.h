#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "lines/segments/line_segment.h"

namespace uav_landing {

/// A line as the search for the vanishing point needs it, in pixels.
struct VanishingCandidate {
  static constexpr double kClearance = 4;  // px between the end of a line and the point where it vanishes
  static constexpr double kMaxHorizonSlope = 0.577;  // 30 degrees of roll

  Eigen::Vector3d line;           // as in LineSegment
  Eigen::Vector2d middle, along;  // along: unit vector
  Eigen::Vector2d top;            // the end that is higher in the image
  double half;                    // half the length
  double offset_variance, angle_variance;

  explicit VanishingCandidate(const LineSegment& s)
      : line(s.line),
        middle(s.middle()),
        along((s.b - s.a).normalized()),
        top(s.a.y() < s.b.y() ? s.a : s.b),
        half(0.5 * s.length()),
        offset_variance(s.offset_stddev * s.offset_stddev),
        angle_variance(s.angle_stddev * s.angle_stddev) {}

  /// From the middle towards the homogeneous point V, scaled by V.z, so that it is finite however far V is.
  Eigen::Vector2d towards(const Eigen::Vector3d& V) const { return V.head<2>() - V.z() * middle; }

  /// Square of the distance by which the segment's ends miss the line from its middle to V, px^2. It is
  /// infinite when the line cannot vanish at V: a line on the ground ends below the horizon and does not
  /// reach V.
  double endMiss2(const Eigen::Vector3d& V) const {
    const Eigen::Vector2d e = towards(V);
    const double ahead = std::abs(along.x() * e.x() + along.y() * e.y());
    if (ahead < (half + kClearance) * V.z()) return std::numeric_limits<double>::infinity();
    const double across = line.x() * e.x() + line.y() * e.y();
    return half * half * across * across / (across * across + ahead * ahead);
  }
  /// Whether part of the line lies above every horizon through V that is not steeper than kMaxHorizonSlope.
  bool isAboveHorizon(const Eigen::Vector3d& V) const {
    const Eigen::Vector2d e = V.head<2>() - V.z() * top;
    return e.y() > kMaxHorizonSlope * std::abs(e.x());
  }
  /// Variance of line.V that follows from the errors of the line's offset and angle.
  double residualVariance(const Eigen::Vector3d& V) const {
    return offset_variance * V.z() * V.z() + angle_variance * std::pow(along.dot(towards(V)), 2);
  }
  double endVariance() const { return offset_variance + half * half * angle_variance; }
};

}  // namespace uav_landing
