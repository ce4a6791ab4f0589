#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <string>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Copies field by field without checks; see checkCalibration().
CameraCalibration toCalibration(const sensor_msgs::CameraInfo& info);

/// Inverse of toCalibration(); the caller sets the header.
sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration, const std_msgs::Header& header);

/// Describes what is wrong with the calibrations of a rig, in the words that all nodelets and programs use:
/// "camera_info: right P[3]: 0, expected ...". A failure of a rig parameter, such as a mask that does not
/// fit, begins with the parameter's name and stays as it is.
Failure ofCameraInfo(const Failure& failure);
/// The same for warnings (see rigWarnings()).
std::vector<std::string> ofCameraInfo(const std::vector<std::string>& warnings);

}  // namespace uav_landing
