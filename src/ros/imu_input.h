#pragma once

#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Core>
#include <optional>
#include <string>

#include "rig_frames.h"
#include "uav_landing/motion/imu_buffer.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// The sample of a message, and what is wrong with the message. As in sensor_msgs/Imu, a covariance that
/// begins with -1 means that the field does not exist. A covariance of zeros, or an impossible one, means
/// that it is unknown. Values that cannot be used are missing from the sample, and the failure names them.
struct ImuReading {
  ImuSample sample;
  Failure failure;
  bool usable() const { return sample.orientation || sample.angular_velocity; }
};
ImuReading toReading(const sensor_msgs::Imu& message);

/// Messages of an inertial sensor and its mounting. It serves the pairs; their left camera may change. Not
/// thread safe.
class ImuInput {
 public:
  /// rows: when the rows of the left camera are exposed.
  explicit ImuInput(const ApproachAngleParameters& parameters, const RowSpan& rows = {})
      : buffer_(parameters, rows), frames_("", "") {}

  /// Takes a message of /tf_static.
  void addTransforms(const tf2_msgs::TFMessage& message) { frames_.add(message, true); }
  /// Takes a message of /tf. It is not used, but the failure names it when the static transform is missing.
  void addMovingTransforms(const tf2_msgs::TFMessage& message) { frames_.add(message, false); }
  /// Adds a message and returns what is wrong with it.
  Failure add(const sensor_msgs::Imu& message);
  /// Whether there is a message at or after an image of this stamp.
  bool covers(const ros::Time& stamp) const { return buffer_.covers(stamp.toSec()); }

  /// Attitude and rotation for the next pair. left_frame: frame of the left camera as it is mounted.
  /// rectified_from_left: R of camera_info.
  AttitudePrior at(const ros::Time& stamp, const std::string& left_frame,
                   const Eigen::Matrix3d& rectified_from_left);

 private:
  ImuBuffer buffer_;
  RigFrames frames_;
  std::string frame_;             // of the sensor
  std::optional<double> before_;  // stamp of the last pair, s
};

}  // namespace uav_landing
