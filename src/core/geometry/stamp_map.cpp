#include "geometry/stamp_map.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace uav_landing {
namespace {

// A point's row changes by some hundredths of the change of its place, and each step leaves this share.
constexpr int kSteps = 3;

// exp(a) x to second order, as the camera turns by at most a few degrees within a readout.
Eigen::Vector3d turned(const Eigen::Vector3d& a, const Eigen::Vector3d& x) {
  const Eigen::Vector3d once = a.cross(x);
  return x + once + 0.5 * a.cross(once);
}

}  // namespace

Eigen::Vector3d GyroTurn::at(double seconds) const {
  if (!rows) return Eigen::Vector3d::Zero();
  return rows->beyondMean(seconds + late) - rows->beyondMean(late);
}

Eigen::Vector3d planeRate(const PlaneVector& plane, const RowMotion& motion) {
  const Eigen::Vector3d& g = plane;
  return motion.w.cross(g) + g * g.normalized().dot(motion.v);
}

StampMap::StampMap(const Eigen::Matrix3d& K, const RowTimes& times, const RowMotion& motion,
                   const Eigen::Vector3d& normal)
    : fx_(K(0, 0)),
      fy_(K(1, 1)),
      cx_(K(0, 2)),
      cy_(K(1, 2)),
      times_(&times),
      motion_(motion),
      normal_(normal) {}

Eigen::Vector3d StampMap::ray(const Eigen::Vector2d& pixel) const {
  return {(pixel.x() - cx_) / fx_, (pixel.y() - cy_) / fy_, 1};
}

Eigen::Vector2d StampMap::project(const Eigen::Vector3d& point) const {
  return {fx_ * point.x() / point.z() + cx_, fy_ * point.y() / point.z() + cy_};
}

// Place at the stamp of a ray that is seen so many seconds after it.
Eigen::Vector2d StampMap::carried(const Eigen::Vector3d& r, double seconds, double inverse_depth) const {
  return project(turned(-motion_.turn(seconds), r) + inverse_depth * seconds * motion_.v);
}

Eigen::Vector2d StampMap::toStamp(const Eigen::Vector2d& pixel) const {
  if (changesNothing()) return pixel;
  const double seconds = times_->at(pixel.x(), pixel.y());
  const Eigen::Vector3d r = ray(pixel), n = turned(motion_.turn(seconds), normal_);
  const double inverse_depth = n.dot(r) / (1 - seconds * normal_.dot(motion_.v));
  return carried(r, seconds, std::max(inverse_depth, 0.0));
}

Eigen::Vector2d StampMap::toStamp(const Eigen::Vector2d& pixel, double inverse_depth) const {
  if (changesNothing()) return pixel;
  return carried(ray(pixel), times_->at(pixel.x(), pixel.y()), inverse_depth);
}

Eigen::Vector2d StampMap::toRow(const Eigen::Vector2d& at_stamp) const {
  return toRow(at_stamp, changesNothing() ? 0 : std::max(normal_.dot(ray(at_stamp)), 0.0));
}

Eigen::Vector2d StampMap::toRow(const Eigen::Vector2d& at_stamp, double inverse_depth) const {
  if (changesNothing()) return at_stamp;
  const Eigen::Vector3d r = ray(at_stamp);
  Eigen::Vector2d pixel = at_stamp;
  for (int step = 0; step < kSteps; ++step) {
    const double seconds = times_->at(pixel.x(), pixel.y());
    pixel = project(turned(motion_.turn(seconds), r - inverse_depth * seconds * motion_.v));
  }
  return pixel;
}

double StampMap::timeOf(const Eigen::Vector3d& point) const {
  if (changesNothing()) return 0;
  const Eigen::Vector2d pixel = toRow(project(point), 1 / point.z());
  return times_->at(pixel.x(), pixel.y());
}

Eigen::Vector3d StampMap::pointAfter(double seconds, const Eigen::Vector3d& point) const {
  return turned(motion_.turn(seconds), point - seconds * motion_.v);
}

Eigen::Vector3d StampMap::directionAfter(double seconds, const Eigen::Vector3d& direction) const {
  return turned(motion_.turn(seconds), direction);
}

}  // namespace uav_landing
