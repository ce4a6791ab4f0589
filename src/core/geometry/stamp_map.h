#pragma once

#include <Eigen/Core>
#include <memory>

#include "geometry/plane_vector.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"
#include "uav_landing/geometry/row_turns.h"

namespace uav_landing {

/// What an inertial sensor measured of a turn, beyond its mean rate.
struct GyroTurn {
  std::shared_ptr<const RowTurns> rows = nullptr;  ///< null: there is no such sensor
  double late = 0;                                 ///< s by which the sensor's times are to be later

  Eigen::Vector3d at(double seconds) const;
};

/// Motion of the camera at the stamp of an image, in its own frame at that time. A scene at rest is at x(t) =
/// exp(turn(t)) (x - v t). Lengths are in units of the height at the stamp.
struct RowMotion {
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< 1/s
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  ///< rad/s^2
  GyroTurn beyond = {};

  /// Rotation vector from the stamp to some seconds after it.
  Eigen::Vector3d turn(double seconds) const { return seconds * (w + seconds / 2 * a) + beyond.at(seconds); }
};

/// Rate of a plane vector, 1/m/s.
Eigen::Vector3d planeRate(const PlaneVector& plane, const RowMotion& motion);

/// Maps a pixel of an image with row times to its place if all rows had been exposed at the stamp, and back.
/// Points are on the ground, or at an inverse depth (times the height) of their own. Pixels above the horizon
/// are at infinity. Without row times every place stays as it is.
/// A pixel's ray r at the time t of its row meets the ground at the inverse depth w = g(t).r, with
///   g(t) = R n / (1 - n.v t),   R = exp(turn(t)).
/// At the stamp, the point is seen in the direction R' r + w v t.
class StampMap {
 public:
  /// A map that leaves every place as it is.
  StampMap() = default;
  /// normal: of the ground, unit vector. K: of the rectified camera. times: must outlive this object.
  StampMap(const Eigen::Matrix3d& K, const RowTimes& times, const RowMotion& motion,
           const Eigen::Vector3d& normal);

  bool changesNothing() const { return times_ == nullptr || times_->atOnce(); }
  Eigen::Vector2d toStamp(const Eigen::Vector2d& pixel) const;
  Eigen::Vector2d toStamp(const Eigen::Vector2d& pixel, double inverse_depth) const;
  /// Place in the image of a point that is here at the stamp.
  Eigen::Vector2d toRow(const Eigen::Vector2d& at_stamp) const;
  Eigen::Vector2d toRow(const Eigen::Vector2d& at_stamp, double inverse_depth) const;
  /// Time from the stamp to the row that sees a point of the frame at the stamp (in heights), s.
  double timeOf(const Eigen::Vector3d& point) const;
  /// The same point in the frame of the camera some seconds after the stamp; the same for a direction.
  Eigen::Vector3d pointAfter(double seconds, const Eigen::Vector3d& point) const;
  Eigen::Vector3d directionAfter(double seconds, const Eigen::Vector3d& direction) const;

 private:
  Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const;
  Eigen::Vector2d project(const Eigen::Vector3d& point) const;
  Eigen::Vector2d carried(const Eigen::Vector3d& ray, double seconds, double inverse_depth) const;

  double fx_ = 1, fy_ = 1, cx_ = 0, cy_ = 0;
  const RowTimes* times_ = nullptr;
  RowMotion motion_;
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitY();
};

}  // namespace uav_landing
