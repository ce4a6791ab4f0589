#pragma once

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/Image.h>

#include <string>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/image/grey_range.h"

namespace uav_landing {

/// The image as mono8 of calibration.imageSize(), or what is wrong with the message (size, step, length of
/// the data, encoding), with the topic's name in front. Shares the message's memory when it is mono8 already;
/// the returned object keeps the message alive. Colour and Bayer images become grey by the luma weights.
/// range: of the values of an image of 16 bit.
Expected<cv_bridge::CvImageConstPtr> toMono8(const sensor_msgs::ImageConstPtr& image,
                                             const CameraCalibration& calibration, const std::string& topic,
                                             const GreyRange& range = {});

/// The range of the pairs of a recording, for both images. A stamp that goes back is of another recording, or
/// of cameras that started anew, and so is the range then.
class PairGreyRange {
 public:
  /// bits: see GreyRangeFinder.
  explicit PairGreyRange(int bits) : finder_(bits), bits_(bits) {}

  /// A pair that has not 16 bit, or cannot be used, leaves the range as it is. Returns what a person should
  /// know, each once; mostly nothing.
  std::string follow(const sensor_msgs::ImageConstPtr& left, const CameraCalibration& left_camera,
                     const sensor_msgs::ImageConstPtr& right, const CameraCalibration& right_camera);
  const GreyRange& range() const { return finder_.range(); }
  void reset() { finder_.reset(); }

 private:
  GreyRangeFinder finder_;
  int bits_;
  ros::Time last_stamp_;
};

}  // namespace uav_landing
