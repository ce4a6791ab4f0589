#pragma once

#include <nodelet/loader.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <uav_landing/LandingEstimate.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>

#include "sequences.h"

namespace uav_landing {
namespace benchmark {

/// All nodelets in this process together with a stereo camera, so messages go from one to the next without a
/// copy. Errors are std::runtime_error.
class NodeletChain {
 public:
  /// A pair as the camera's driver has it, ready to be published.
  struct Pair {
    sensor_msgs::ImagePtr left, right;
    sensor_msgs::CameraInfoPtr left_info, right_info;
  };

  /// Needs a ROS master.
  explicit NodeletChain(const Sequence& sequence);
  ~NodeletChain();

  static Pair message(const Sequence& sequence, size_t pair, const ros::Time& stamp);

  /// Subscribes the estimates and waits until the stages are connected: it publishes the pair, with earlier
  /// stamps, until an estimate comes.
  void listen(const Sequence& sequence, size_t pair);
  /// Unsubscribes the estimates, so that the cameras have no subscriber.
  void stopListening();

  void publish(const Pair& pair);
  /// Time from publishing the pair to its estimate.
  std::chrono::steady_clock::duration process(const Pair& pair);

 private:
  struct View {
    ros::Publisher image, info;
  };
  static View advertise(const std::string& side);
  uint32_t subscribers() const;
  bool waitFor(const ros::Time& stamp, std::chrono::milliseconds deadline);

  ros::NodeHandle handle_;
  ros::AsyncSpinner spinner_{1};
  View left_, right_;
  nodelet::Loader loader_{false};

  std::mutex mutex_;
  std::condition_variable came_;
  ros::Time latest_;  // of the latest estimate, and when it came
  std::chrono::steady_clock::time_point when_;
  ros::Subscriber estimates_;
};

}  // namespace benchmark
}  // namespace uav_landing
