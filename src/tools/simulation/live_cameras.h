#pragma once

#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "uav_landing/results/truth.h"

namespace uav_landing {

/// Publishes image pairs as the driver of two triggered cameras does, and the clock that their stamps are of:
/// /CAMERA/{left,right}/{image_raw,camera_info}, /truth/landing_estimate, /clock. Sets /use_sim_time. Needs
/// ros::init() and a master. The clock never runs ahead of the pictures: when they come late, time passes
/// more slowly.
class LiveCameras {
 public:
  /// speed: seconds of the clock in a second, at most.
  LiveCameras(const std::string& camera, const sensor_msgs::CameraInfo& left,
              const sensor_msgs::CameraInfo& right, double speed);

  /// Until both cameras have a subscriber, and all that the master knows to subscribe one of the topics are
  /// connected, so that nobody misses the first pairs; for those twenty seconds at most, as one may have
  /// died. The clock stands at start. False when ROS was shut down; throws when nobody subscribes for ten
  /// minutes.
  bool waitForSubscribers(const ros::Time& start);
  /// Puts the clock forward.
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
