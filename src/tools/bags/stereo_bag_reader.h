#pragma once

#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pairing.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Streams the image pairs of a bag and an inertial sensor, message by message.
class StereoBagReader {
 public:
  /// Throws std::runtime_error with a message for the user when the file cannot be opened as a bag.
  /// camera: namespace of the cameras without a slash in front. imu: topic, may be missing in the bag; "":
  /// none.
  StereoBagReader(const std::string& path, const std::string& camera, const std::string& imu);

  /// Which topic is missing or of another type, and what the bag contains instead. imu_needed: that of the
  /// inertial sensor must be there, too.
  Failure checkTopics(bool imu_needed) const;
  /// There are messages of the inertial sensor.
  bool hasImu() const;
  /// Left images in the bag.
  std::size_t leftImages() const;
  std::size_t messages() const;
  /// Left image, left camera_info, right image, right camera_info.
  const std::array<std::string, 4>& topics() const { return topics_; }

  /// Calls visit for every message of /tf_static.
  void readStaticTransforms(const std::function<void(const tf2_msgs::TFMessage&)>& visit) const;
  /// Hands every message to the pairing or to imu, in the order of the bag; after each of them calls
  /// progress(). Throws ros::Exception where the file is damaged.
  void read(StereoPairing& pairing, const std::function<void(const sensor_msgs::Imu&)>& imu,
            const std::function<void()>& progress) const;

 private:
  std::vector<std::string> wanted() const;

  std::optional<rosbag::Bag> bag_;
  std::array<std::string, 4> topics_;
  std::string imu_;
};

}  // namespace uav_landing
