#pragma once

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bags/pair_plan.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Reads the image pairs of a recording, and an inertial sensor. A recording is one bag, or the parts of a
/// split one. A first pass reads the stamps. The second one reads the images in the order of the pairs. So
/// the order in the bag does not matter, and only one pair is in memory.
class StereoBagReader {
 public:
  /// Throws std::runtime_error with a message for the user when a file cannot be opened as a bag. Topics that
  /// were recorded without a slash in front are found, too.
  /// camera: namespace of the cameras without a slash in front.
  /// imu: topic, which may be missing in the bag; "": none.
  StereoBagReader(const std::vector<std::string>& paths, const std::string& camera, const std::string& imu);

  /// Says which topic is missing or has another type, what the bag contains instead, and which command can
  /// read it. imu_needed: the topic of the inertial sensor must exist, too.
  Failure checkTopics(bool imu_needed) const;
  /// Whether there are messages of the inertial sensor.
  bool hasImu() const;
  /// Number of messages that plan() reads.
  std::size_t messages() const;
  /// Left image, left camera_info, right image, right camera_info.
  const std::array<std::string, 4>& topics() const { return topics_; }

  /// Calls visit for every message of /tf_static.
  void readStaticTransforms(const std::function<void(const tf2_msgs::TFMessage&)>& visit) const;
  /// Reads the stamps and pairs them; after each message it calls progress(). Throws ros::Exception when the
  /// file is damaged.
  PairPlan plan(const RectifyParameters& parameters, const std::function<void()>& progress);

  using PairVisitor = std::function<void(
      const sensor_msgs::ImageConstPtr& left, const sensor_msgs::CameraInfoConstPtr& left_info,
      const sensor_msgs::ImageConstPtr& right, const sensor_msgs::CameraInfoConstPtr& right_info)>;
  /// Passes on the pairs of plan(), and between them the messages of the inertial sensor in their recorded
  /// order. Throws as plan() does.
  void read(const PairPlan& plan, const PairVisitor& pair,
            const std::function<void(const sensor_msgs::Imu&)>& imu) const;

 private:
  struct Placed {
    rosbag::MessageInstance message;
    std::size_t place;  // index among all messages
  };
  /// The names of a topic in the bags: with and without a slash in front.
  std::vector<std::string> namesOf(const std::string& topic) const;
  std::vector<std::string> wanted() const;

  std::vector<std::string> paths_;
  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::array<std::string, 4> topics_;
  std::string imu_;
  std::array<std::vector<Placed>, 4> inputs_;  // filled by plan()
  std::vector<Placed> imu_messages_;
};

}  // namespace uav_landing
