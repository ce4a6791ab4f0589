#pragma once

#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "uav_landing/results/truth.h"

namespace uav_landing {

/// Publishes image pairs as the driver of two triggered cameras does, and the clock of their stamps. The
/// topics are /CAMERA/{left,right}/{image_raw,camera_info}, /truth/landing_estimate and /clock. Sets
/// /use_sim_time. Needs ros::init() and a master. The clock never runs ahead of the images: when they come
/// late, time passes more slowly.
class LiveCameras {
 public:
  /// speed: largest number of seconds of the clock per second.
  LiveCameras(const std::string& camera, const sensor_msgs::CameraInfo& left,
              const sensor_msgs::CameraInfo& right, double speed);

  /// Waits until both cameras have a subscriber and all subscribers known to the master are connected. So
  /// nobody misses the first pairs. For the latter it waits at most twenty seconds, because a subscriber may
  /// have died. The clock stands at start. False when ROS was shut down; throws when nobody subscribes for
  /// ten minutes.
  bool waitForSubscribers(const ros::Time& start);
  /// Sets the clock.
  void setClock(const ros::Time& now);
  /// Lets the clock run to the stamp and publishes the pair: raw mono8. False when ROS was shut down.
  bool publish(const ros::Time& stamp, const cv::Mat& left, const cv::Mat& right, const Truth& truth);

 private:
  struct Camera {
    ros::Publisher image, info;
    sensor_msgs::CameraInfo calibration;
  };
  Camera advertise(const std::string& topic, const std::string& frame,
                   const sensor_msgs::CameraInfo& calibration);
  static void publish(Camera& camera, const ros::Time& stamp, const cv::Mat& image);
  bool runClock(const ros::Time& until);
  bool seen() const;
  bool allConnected() const;

  const double speed_;
  ros::NodeHandle handle_;
  Camera left_, right_;
  ros::Publisher truth_, clock_;
  std::optional<ros::Time> now_;
};

}  // namespace uav_landing
