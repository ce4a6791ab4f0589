#pragma once

#include "lines/segments/line_segment.h"
#include "support/ground_renderer.h"

namespace uav_landing {
namespace test {

/// Image of a line along x on the ground, from near to far. y, from, to: m.
/// offset: of the camera to the right of the left one, m.
/// brighter_left: whether its left side is the brighter one.
inline LineSegment groundLine(const StereoRig& rig, const Pose& pose, double y, double from, double to,
                              double offset, bool brighter_left) {
  const auto pixel = [&](double x) -> Eigen::Vector2d {
    const Eigen::Vector3d point =
        pose.seen(Eigen::Vector3d(x, y, 0) - pose.position) - Eigen::Vector3d(offset, 0, 0);
    const double cx = offset > 0 ? rig.cx_right : rig.cx;
    return {rig.fx * point.x() / point.z() + cx, rig.fy * point.y() / point.z() + rig.cy};
  };
  const Eigen::Vector2d a = pixel(from), b = pixel(to), along = (b - a).normalized();
  // Left of the direction of travel is -u when going up the picture.
  Eigen::Vector2d normal(along.y(), -along.x());
  if (!brighter_left) normal = -normal;
  return {a, b, {normal.x(), normal.y(), -normal.dot(a)}, 0.1, 1e-3};
}

}  // namespace test
}  // namespace uav_landing
