#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace uav_landing {

/// A rectangle of ground around (x, y) with its sides along the axes of a frame, metres.
struct GroundPatch {
  float x, y;
  float length, width;  ///< extents along x and y, positive
};

/// A frame on the ground: its origin and the direction of its x axis in the runway frame.
struct GroundFrame {
  Eigen::Vector2f origin, axis;
  /// direction_deg: angle to the left of the landing direction.
  GroundFrame(double x, double y, double direction_deg)
      : origin(Eigen::Vector2d(x, y).cast<float>()),
        axis(Eigen::Vector2d(std::cos(direction_deg * M_PI / 180), std::sin(direction_deg * M_PI / 180))
                 .cast<float>()) {}
  /// Turns a vector of the runway frame into this frame.
  Eigen::Vector2f turned(const Eigen::Vector2f& v) const {
    return {axis.dot(v), axis.x() * v.y() - axis.y() * v.x()};
  }
};

/// The ground that a sample of the image covers: a parallelogram with sides u and v. It is replaced by a box
/// along the axes with the same variance. The axes are those of a frame in which an edge is parallel to an
/// axis.
struct GroundFootprint {
  GroundPatch box;       ///< in the runway frame
  Eigen::Vector2f u, v;  ///< its sides in the runway frame

  GroundFootprint(float x, float y, const Eigen::Vector2f& u, const Eigen::Vector2f& v)
      : box{x, y, std::sqrt(u.x() * u.x() + v.x() * v.x()), std::sqrt(u.y() * u.y() + v.y() * v.y())},
        u(u),
        v(v) {}

  GroundPatch in(const GroundFrame& frame) const {
    const Eigen::Vector2f middle = frame.turned(Eigen::Vector2f(box.x, box.y) - frame.origin);
    const Eigen::Vector2f along_u = frame.turned(u), along_v = frame.turned(v);
    return {middle.x(), middle.y(), std::hypot(along_u.x(), along_v.x()),
            std::hypot(along_u.y(), along_v.y())};
  }
  /// The same footprint with all sides longer by this factor.
  GroundFootprint scaled(float factor) const {
    GroundFootprint result = *this;
    result.box.length *= factor;
    result.box.width *= factor;
    result.u *= factor;
    result.v *= factor;
    return result;
  }
};

/// Share of the interval of this width around the centre that lies within [from, to]. It is exactly 0 or 1
/// when none or all of it does.
inline float overlap(float centre, float width, float from, float to) {
  const float low = centre - 0.5f * width, high = centre + 0.5f * width;
  if (low >= from && high <= to) return 1.0f;
  return std::max(std::min(to, high) - std::max(from, low), 0.0f) / width;
}

/// Length of the dashes within [0, s], s >= 0. A dash is the part [0, dash) of every period.
inline float dashesUpTo(float s, float dash, float period) {
  const float whole = std::floor(s / period);
  return whole * dash + std::min(s - whole * period, dash);
}

}  // namespace uav_landing
