#pragma once

#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/TimeReference.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <string>

namespace uav_landing {
namespace test {

/// A level stereo rig over a textured plane, pitched down, that descends along a straight path. Ideal
/// cameras.
struct StereoScene {
  int width = 320, height = 240;
  double f = 260, baseline = 0.3;
  double pitch = -15 * M_PI / 180;
  double calibrated_scale = 1;  // by which the picture that K is of is larger
  double start_height = 2.0, speed = 2.0, approach_angle = 6 * M_PI / 180;

  double heightAt(double t) const { return start_height - speed * std::sin(approach_angle) * t; }

  sensor_msgs::ImagePtr image(double t, bool right) const {
    auto image = blank(0);
    const double x0 = speed * std::cos(approach_angle) * t, h = heightAt(t);
    const double cp = std::cos(pitch), sp = std::sin(pitch);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double rx = (u - 0.5 * width) / f, ry = (v - 0.5 * height) / f;
        const double down = ry * cp - sp, forward = cp + ry * sp;  // the optical axis rises by the pitch
        uint8_t grey = 200;                                        // sky
        if (down > 0.03) {
          const double distance = h / down;
          grey = texture(x0 + forward * distance, rx * distance + (right ? baseline : 0));
        }
        image->data[static_cast<size_t>(v * width + u)] = grey;
      }
    }
    return image;
  }

  sensor_msgs::ImagePtr blank(uint8_t grey) const {
    auto image = boost::make_shared<sensor_msgs::Image>();
    image->width = static_cast<uint32_t>(width);
    image->height = static_cast<uint32_t>(height);
    image->step = image->width;
    image->encoding = sensor_msgs::image_encodings::MONO8;
    image->data.assign(image->step * image->height, grey);
    return image;
  }

  sensor_msgs::CameraInfoPtr info(bool right) const {
    auto info = boost::make_shared<sensor_msgs::CameraInfo>();
    info->width = static_cast<uint32_t>(width);
    info->height = static_cast<uint32_t>(height);
    info->distortion_model = "plumb_bob";
    info->D = {0, 0, 0, 0, 0};
    const double s = calibrated_scale;
    info->K = {s * f, 0, s * 0.5 * width, 0, s * f, s * 0.5 * height, 0, 0, 1};
    info->R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    info->P = {f, 0, 0.5 * width, right ? -f * baseline : 0, 0, f, 0.5 * height, 0, 0, 0, 1, 0};
    return info;
  }

 private:
  static double noise(int x, int y) {
    uint32_t hash = static_cast<uint32_t>(x) * 374761393u + static_cast<uint32_t>(y) * 668265263u;
    hash = (hash ^ (hash >> 13)) * 1274126177u;
    return static_cast<double>((hash ^ (hash >> 16)) & 0xffff) / 65535;
  }
  /// Smooth noise with details of 10 and 30 cm.
  static uint8_t texture(double x, double y) {
    double grey = 0;
    for (const double cell : {0.1, 0.3}) {
      const double cx = x / cell, cy = y / cell;
      const int ix = static_cast<int>(std::floor(cx)), iy = static_cast<int>(std::floor(cy));
      double wx = cx - ix, wy = cy - iy;
      wx = wx * wx * (3 - 2 * wx);
      wy = wy * wy * (3 - 2 * wy);
      grey += (noise(ix, iy) * (1 - wx) + noise(ix + 1, iy) * wx) * (1 - wy) +
              (noise(ix, iy + 1) * (1 - wx) + noise(ix + 1, iy + 1) * wx) * wy;
    }
    return static_cast<uint8_t>(20 + 100 * grey);
  }
};

/// Publishes pairs as the cameras do (raw) or as rectify does.
class PairPublisher {
 public:
  enum Kind { kRaw, kRectified };

  explicit PairPublisher(Kind kind) : kind_(kind) {
    const std::string space = kind == kRaw ? "/stereo/" : "/uav_landing/";
    const std::string image = kind == kRaw ? "image_raw" : "image_rect";
    ros::NodeHandle handle;
    left_ = handle.advertise<sensor_msgs::Image>(space + "left/" + image, 100);
    right_ = handle.advertise<sensor_msgs::Image>(space + "right/" + image, 100);
    left_info_ = handle.advertise<sensor_msgs::CameraInfo>(space + "left/camera_info", 100);
    right_info_ = handle.advertise<sensor_msgs::CameraInfo>(space + "right/camera_info", 100);
    if (kind == kRectified)
      time_ = handle.advertise<sensor_msgs::TimeReference>(space + "right/time_reference", 100);
  }

  /// What rectify tells of the right image's time has a subscriber.
  bool timeIsConnected() const { return time_.getNumSubscribers() > 0; }
  /// All images have a subscriber, or those of the stage at hand.
  bool connected() const {
    return left_.getNumSubscribers() > 0 && right_.getNumSubscribers() > 0 &&
           left_info_.getNumSubscribers() > 0 && right_info_.getNumSubscribers() > 0;
  }
  bool unconnected() const {
    return left_.getNumSubscribers() + right_.getNumSubscribers() + left_info_.getNumSubscribers() +
               right_info_.getNumSubscribers() ==
           0;
  }

  void publishLeft(const ros::Time& stamp, const sensor_msgs::ImagePtr& image,
                   const sensor_msgs::CameraInfoPtr& info) const {
    info->header.stamp = image->header.stamp = stamp;
    info->header.frame_id = image->header.frame_id = "left_optical";
    left_info_.publish(info);
    left_.publish(image);
  }
  void publishRight(const ros::Time& stamp, const sensor_msgs::ImagePtr& image,
                    const sensor_msgs::CameraInfoPtr& info) const {
    info->header.stamp = image->header.stamp = stamp;
    info->header.frame_id = image->header.frame_id = "right_optical";
    right_info_.publish(info);
    right_.publish(image);
    if (kind_ != kRectified) return;
    auto time = boost::make_shared<sensor_msgs::TimeReference>();
    time->header.stamp = stamp;
    time->time_ref = stamp;
    time_.publish(time);
  }

  /// The scene at t seconds after its start.
  void publish(const StereoScene& scene, double t) const {
    publishLeft(stampOf(t), scene.image(t, false), scene.info(false));
    publishRight(stampOf(t), scene.image(t, true), scene.info(true));
  }
  void publishUniform(const StereoScene& scene, double t, uint8_t grey) const {
    publishLeft(stampOf(t), scene.blank(grey), scene.info(false));
    publishRight(stampOf(t), scene.blank(grey), scene.info(true));
  }

  static ros::Time stampOf(double t) { return ros::Time(1000) + ros::Duration(t); }

 private:
  Kind kind_;
  ros::Publisher left_, right_, left_info_, right_info_, time_;
};

}  // namespace test
}  // namespace uav_landing
