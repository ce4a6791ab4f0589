#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <string>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Field by field, nothing checked: see checkCalibration().
CameraCalibration toCalibration(const sensor_msgs::CameraInfo& info);

/// Inverse of toCalibration(); the header is the caller's.
sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration, const std_msgs::Header& header);

/// What is wrong with the calibrations of a rig, in the words of all nodelets and programs:
/// "camera_info: right P[3]: 0, expected ...". What is wrong with a parameter of the rig, such as a mask that
/// does not fit, begins with the parameter's name and stays.
Failure ofCameraInfo(const Failure& failure);
/// The same for what is unlikely about them (see rigWarnings()).
std::vector<std::string> ofCameraInfo(const std::vector<std::string>& warnings);

}  // namespace uav_landing
