#pragma once

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/Image.h>

#include <string>

#include "image/input/grey_range.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// The image as mono8 of calibration.imageSize(). The failure names the topic and what is wrong with the
/// message (size, step, length of the data, encoding). A mono8 message's memory is shared, and the returned
/// object keeps the message alive. Colour and Bayer images become grey by the luma weights. range: of the
/// values of a 16-bit image.
Expected<cv_bridge::CvImageConstPtr> toMono8(const sensor_msgs::ImageConstPtr& image,
                                             const CameraCalibration& calibration, const std::string& topic,
                                             const GreyRange& range = {});

/// The grey range of a recording's pairs, for both images. When a stamp goes back, this is another recording,
/// or the cameras have restarted. Then the range is found anew.
class PairGreyRange {
 public:
  /// bits: see GreyRangeFinder.
  explicit PairGreyRange(int bits) : finder_(bits), bits_(bits) {}

  /// Takes a pair. A pair that does not have 16 bits, or that cannot be used, leaves the range as it is.
  /// Returns a message for people, each one once; mostly nothing.
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
