#include "lines/segments/line_segment.h"

namespace uav_landing {

LineSegment makeLineSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double offset_stddev,
                            double angle_stddev) {
  const Eigen::Vector2d along = (b - a).normalized(), across(-along.y(), along.x());
  return {a, b, {across.x(), across.y(), -across.dot(0.5 * (a + b))}, offset_stddev, angle_stddev};
}

}  // namespace uav_landing
