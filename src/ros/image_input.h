#pragma once

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/Image.h>

#include <string>

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// The image as mono8 of calibration.imageSize(), or what is wrong with the message (size, step, length of
/// the data, encoding), with the topic's name in front. Shares the message's memory when it is mono8 already;
/// the returned object keeps the message alive. mono16 is taken as full range: 65535 becomes 255, so a camera
/// that delivers fewer bits must shift them up. Colour and Bayer images become grey by the luma weights.
Expected<cv_bridge::CvImageConstPtr> toMono8(const sensor_msgs::ImageConstPtr& image,
                                             const CameraCalibration& calibration, const std::string& topic);

}  // namespace uav_landing
