#include "bags/stereo_bag_writer.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/algorithm/string.hpp>
#include <cmath>
#include <filesystem>

namespace uav_landing {
namespace {

constexpr char kImuFrame[] = "imu_link";

/// Truth is exact: variance 0 for a known value.
double varianceOf(double value) { return std::isnan(value) ? kUnknown : 0.0; }

/// Velocity of the step. Its direction is that of the focus of expansion, seen from the rectified left
/// camera.
Eigen::Vector3d velocityOf(const Truth& truth, const sensor_msgs::CameraInfo& left) {
  const Eigen::Vector3d ray((truth.foe.x() - left.P[2]) / left.P[0], (truth.foe.y() - left.P[6]) / left.P[5],
                            1.0);
  return truth.speed * ray.normalized();
}

}  // namespace

LandingEstimate truthMessage(const Truth& truth, const sensor_msgs::CameraInfo& left, const ros::Time& stamp,
                             const std::string& left_frame) {
  LandingEstimate message;
  message.header.stamp = stamp;
  message.header.frame_id = "runway";
  message.child_frame_id = left_frame + "_rect";
  message.height_valid = !std::isnan(truth.height);
  message.angle_valid = !std::isnan(truth.approach_angle);
  message.valid = message.height_valid && message.angle_valid;
  message.status = message.height_valid ? LandingEstimate::TRACKING : LandingEstimate::SEARCHING;
  message.height = message.raw_height = message.points_height = truth.height;
  message.height_variance = message.raw_height_variance = varianceOf(truth.height);
  message.approach_angle = message.raw_approach_angle = truth.approach_angle;
  message.approach_angle_variance = message.raw_approach_angle_variance = varianceOf(truth.approach_angle);
  message.vertical_speed = -truth.speed * std::sin(truth.approach_angle);
  message.vertical_speed_variance = varianceOf(message.vertical_speed);
  message.pitch = truth.pitch;
  message.pitch_variance = varianceOf(truth.pitch);
  message.roll = truth.roll;
  message.roll_variance = varianceOf(truth.roll);
  message.yaw_known = !std::isnan(truth.yaw);
  message.yaw = truth.yaw;
  message.yaw_variance = varianceOf(truth.yaw);
  message.foe = {truth.foe.x(), truth.foe.y()};
  const Eigen::Vector3d velocity = velocityOf(truth, left);
  message.velocity = {velocity.x(), velocity.y(), velocity.z()};
  message.angular_velocity.assign(kUnknown);
  message.twist_covariance.assign(kUnknown);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) message.twist_covariance[6 * i + j] = varianceOf(velocity.x());
  message.innovation = message.innovation_variance = kUnknown;
  message.x_known = !std::isnan(truth.x);
  message.y_known = !std::isnan(truth.y);
  message.x = truth.x;
  message.x_variance = varianceOf(truth.x);
  message.y = truth.y;
  message.y_variance = varianceOf(truth.y);
  message.y_protection_level = kUnknown;
  message.height_above_runway_protection_level = message.height_above_runway_limit = kUnknown;
  message.runway_width = message.runway_width_variance = kUnknown;
  message.width_height = message.width_height_variance = kUnknown;
  message.height_protection_level = kUnknown;
  message.compute_ms = kUnknown;
  return message;
}

std::string opticalFrame(const std::string& camera, const std::string& side) {
  return boost::replace_all_copy(camera, "/", "_") + "_" + side + "_optical_frame";
}

StereoBagWriter::StereoBagWriter(const std::string& path, const std::string& camera,
                                 const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right)
    : path_(path), temporary_path_(path + ".active"), camera_(camera), left_(left), right_(right) {
  left_.header.frame_id = opticalFrame(camera, "left");
  right_.header.frame_id = opticalFrame(camera, "right");
  bag_.open(temporary_path_, rosbag::bagmode::Write);
}

StereoBagWriter::~StereoBagWriter() {
  if (temporary_path_.empty()) return;
  try {
    bag_.close();
  } catch (const rosbag::BagException&) {
    // The bag is given up anyway.
  }
  std::error_code ignored;
  std::filesystem::remove(temporary_path_, ignored);
}

void StereoBagWriter::write(const ros::Time& stamp, const cv::Mat& left, const cv::Mat& right,
                            const Truth& truth) {
  writeCamera("left", stamp, left, left_);
  writeCamera("right", stamp, right, right_);
  bag_.write("/truth/landing_estimate", stamp, truthMessage(truth, left_, stamp, left_.header.frame_id));
}

void StereoBagWriter::writeImu(const ros::Time& stamp, const ImuSample& sample,
                               const Eigen::Matrix3d& left_from_imu) {
  if (!mounting_written_) writeMounting(stamp, left_from_imu);
  mounting_written_ = true;
  const auto store = [](const std::optional<Eigen::Matrix3d>& covariance, boost::array<double, 9>& out) {
    // Zeros mean that the covariance is not known.
    const Eigen::Matrix3d known = covariance.value_or(Eigen::Matrix3d::Zero());
    for (int i = 0; i < 9; ++i) out[static_cast<size_t>(i)] = known(i / 3, i % 3);
  };
  sensor_msgs::Imu message;
  message.header.stamp = stamp;
  message.header.frame_id = kImuFrame;
  if (sample.orientation) {
    tf2::convert(*sample.orientation, message.orientation);
    store(sample.orientation_covariance, message.orientation_covariance);
  } else {
    message.orientation_covariance[0] = -1;
  }
  if (sample.angular_velocity) {
    tf2::toMsg(*sample.angular_velocity, message.angular_velocity);
    store(sample.angular_velocity_covariance, message.angular_velocity_covariance);
  } else {
    message.angular_velocity_covariance[0] = -1;
  }
  message.linear_acceleration_covariance[0] = -1;
  bag_.write("/imu/data", stamp, message);
}

void StereoBagWriter::writeMounting(const ros::Time& stamp, const Eigen::Matrix3d& left_from_imu) {
  tf2_msgs::TFMessage mounting;
  mounting.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = mounting.transforms[0];
  transform.header.stamp = stamp;
  transform.header.frame_id = left_.header.frame_id;
  transform.child_frame_id = kImuFrame;
  tf2::convert(Eigen::Quaterniond(left_from_imu), transform.transform.rotation);
  // Latched, so that later listeners get it, too.
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["latching"] = "1";
  (*header)["type"] = ros::message_traits::datatype(mounting);
  (*header)["md5sum"] = ros::message_traits::md5sum(mounting);
  (*header)["message_definition"] = ros::message_traits::definition(mounting);
  (*header)["callerid"] = "/simulate_approach";
  bag_.write("/tf_static", stamp, mounting, header);
}

void StereoBagWriter::writeCamera(const std::string& side, const ros::Time& stamp, const cv::Mat& image,
                                  sensor_msgs::CameraInfo& info) {
  info.header.stamp = stamp;
  const std::string topic = "/" + camera_ + "/" + side;
  bag_.write(topic + "/camera_info", stamp, info);
  bag_.write(topic + "/image_raw", stamp,
             cv_bridge::CvImage(info.header, sensor_msgs::image_encodings::MONO8, image).toImageMsg());
}

void StereoBagWriter::finish() {
  bag_.close();
  std::filesystem::rename(temporary_path_, path_);
  temporary_path_.clear();
}

}  // namespace uav_landing
