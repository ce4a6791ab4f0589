#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>

#include <opencv2/core.hpp>
#include <string>

#include "uav_landing/LandingEstimate.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/motion/imu_buffer.h"
#include "uav_landing/results/truth.h"

namespace uav_landing {

/// Truth of one frame as a message: known values with variance 0, the rest NaN. The velocity is in the
/// rectified left camera's optical frame. It is known when speed and focus of expansion are.
LandingEstimate truthMessage(const Truth& truth, const sensor_msgs::CameraInfo& left, const ros::Time& stamp,
                             const std::string& left_frame);

/// frame_id of a simulated or converted camera: slashes of the namespace become underscores.
std::string opticalFrame(const std::string& camera, const std::string& side);

/// Writes image pairs with their truth to a bag, as if the driver of a stereo camera was recorded. The topics
/// are /CAMERA/{left,right}/{image_raw,camera_info} and /truth/landing_estimate, and /imu/data if there is an
/// inertial sensor. It writes to "<path>.active". finish() renames this file, and without finish() it is
/// removed.
class StereoBagWriter {
 public:
  /// Opens the bag. Throws rosbag::BagException when that is not possible. camera: namespace, without slashes
  /// at the ends.
  StereoBagWriter(const std::string& path, const std::string& camera, const sensor_msgs::CameraInfo& left,
                  const sensor_msgs::CameraInfo& right);
  ~StereoBagWriter();
  StereoBagWriter(const StereoBagWriter&) = delete;
  StereoBagWriter& operator=(const StereoBagWriter&) = delete;

  /// left, right: raw mono8.
  void write(const ros::Time& stamp, const cv::Mat& left, const cv::Mat& right, const Truth& truth);
  /// Writes a message of the inertial sensor on /imu/data, and once its mounting on /tf_static. stamp: of the
  /// message. left_from_imu: rotation to the optical frame of the left camera as it is mounted.
  void writeImu(const ros::Time& stamp, const ImuSample& sample, const Eigen::Matrix3d& left_from_imu);
  void finish();

 private:
  void writeMounting(const ros::Time& stamp, const Eigen::Matrix3d& left_from_imu);
  void writeCamera(const std::string& side, const ros::Time& stamp, const cv::Mat& image,
                   sensor_msgs::CameraInfo& info);

  std::string path_, temporary_path_, camera_;
  sensor_msgs::CameraInfo left_, right_;
  rosbag::Bag bag_;
  bool mounting_written_ = false;
};

}  // namespace uav_landing
