#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// A straight edge, refined to sub-pixel, in pixels of the rectified image.
struct LineSegment {
  Eigen::Vector2d a, b;  ///< end points
  Eigen::Vector3d line;  ///< homogeneous, (l0, l1) of unit length: l.[u v 1] is the distance in pixels
  double offset_stddev;  ///< of the distance at the segment's middle, pixels
  double angle_stddev;   ///< of the direction, rad

  double length() const { return (b - a).norm(); }
  Eigen::Vector2d middle() const { return 0.5 * (a + b); }
};

/// Line from a to b with these standard deviations (px, rad). Its normal is 90 degrees clockwise (in the
/// image) of this direction.
LineSegment makeLineSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double offset_stddev,
                            double angle_stddev);

/// A straight edge, good to about a pixel.
struct RoughSegment {
  Eigen::Vector2d a, b;                                ///< ends, px
  Eigen::Vector2d brighter = Eigen::Vector2d::Zero();  ///< roughly towards the brighter side; 0: not known
};

}  // namespace uav_landing
