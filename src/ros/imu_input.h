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

/// The sample of a message. As sensor_msgs/Imu has it, -1 in front of a covariance means that there is no
/// such field, and a covariance of zeros that it is not known; so does one that is none. What cannot be used
/// is left out of the sample, and the failure names it.
struct ImuReading {
  ImuSample sample;
  Failure failure;
  bool usable() const { return sample.orientation || sample.angular_velocity; }
};
ImuReading toReading(const sensor_msgs::Imu& message);

/// Messages of an inertial sensor and where it is mounted, for the pairs of one left camera after another.
/// Not thread safe.
class ImuInput {
 public:
  explicit ImuInput(const ApproachAngleParameters& parameters) : buffer_(parameters), frames_("", "") {}

  /// A message of /tf_static.
  void addTransforms(const tf2_msgs::TFMessage& message) { frames_.add(message, true); }
  /// A message of /tf: not used, but the failure says so where the static transform is missing.
  void addMovingTransforms(const tf2_msgs::TFMessage& message) { frames_.add(message, false); }
  /// Returns what is wrong with the message.
  Failure add(const sensor_msgs::Imu& message);
  /// There is a message at or after an image of this stamp.
  bool covers(const ros::Time& stamp) const { return buffer_.covers(stamp.toSec()); }

  /// For the next pair. left_frame: of the left camera as it is mounted; rectified_from_left: camera_info's
  /// R.
  AttitudePrior at(const ros::Time& stamp, const std::string& left_frame,
                   const Eigen::Matrix3d& rectified_from_left);

 private:
  ImuBuffer buffer_;
  RigFrames frames_;
  std::string frame_;             // of the sensor
  std::optional<double> before_;  // stamp of the last pair, s
};

}  // namespace uav_landing
