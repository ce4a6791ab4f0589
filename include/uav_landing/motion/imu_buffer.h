#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>

#include "uav_landing/geometry/row_times.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/results/attitude_prior.h"

namespace uav_landing {

/// One message of an inertial sensor, in its own axes.
struct ImuSample {
  double stamp = 0;  ///< s
  /// Orientation of the sensor in a world whose z axis points up (REP 103). Its heading is not used.
  std::optional<Eigen::Quaterniond> orientation;
  std::optional<Eigen::Matrix3d> orientation_covariance;  ///< rad^2, about the sensor's axes; none: not known
  std::optional<Eigen::Vector3d> angular_velocity;        ///< rad/s
  std::optional<Eigen::Matrix3d> angular_velocity_covariance;  ///< rad^2/s^2; none: not known
};

/// Keeps the messages of an inertial sensor over the last minute. It gives attitude and rotation at the
/// stamps of images.
class ImuBuffer {
 public:
  /// rows: when the rows of the images are exposed.
  explicit ImuBuffer(const ApproachAngleParameters& parameters, const RowSpan& rows = {})
      : parameters_(parameters), rows_(rows) {}

  /// Adds a message. A slightly late one is put in its place, and one with a repeated stamp is ignored. A
  /// stamp that is more than a second back means that the clock was set back, so earlier messages are
  /// forgotten.
  void add(const ImuSample& sample);
  void clear() { samples_.clear(); }
  bool empty() const { return samples_.empty(); }
  double newest() const { return samples_.back().stamp; }  ///< s; not while empty
  /// Whether there is a message at or after the image of this stamp, with imu_delay taken into account. Where
  /// the messages are frequent enough for rows, it is at or after the last row.
  bool covers(double stamp) const;

  /// Attitude at the image of this stamp, and the rotation since the image before. camera_from_imu: rotation
  /// to the optical frame of the rectified left camera.
  ///
  /// The attitude is interpolated between the neighbours in time, or carried on from the newest message for
  /// at most imu_max_gap. The rotation follows from the angular velocity or, without one, from the attitudes.
  /// Where rows have times, messages at 200 Hz or more tell the turns between them.
  AttitudePrior at(double stamp, std::optional<double> before, const Eigen::Matrix3d& camera_from_imu) const;

 private:
  std::optional<ImuSample> interpolate(double t) const;
  Failure missing(double t) const;
  std::optional<Eigen::Quaterniond> integrate(const ImuSample& from, const ImuSample& to) const;
  Eigen::Matrix3d attitudeCovariance(const ImuSample& sample) const;
  Eigen::Matrix3d rateCovariance(const ImuSample& sample) const;

  /// Longest time between the messages around these times, s.
  double longestGap(double from, double to) const;
  Eigen::Vector3d rateAt(double t) const;
  void addRows(double stamp, const Eigen::Matrix3d& camera_from_imu, AttitudePrior& prior) const;

  ApproachAngleParameters parameters_;
  RowSpan rows_;
  std::deque<ImuSample> samples_;  // in the order of their stamps
};

}  // namespace uav_landing
