#pragma once

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/results/truth.h"

namespace uav_landing {

/// A frame of a dataset folder. The folder has left/*.png and right/*.png (mono8), left.yaml and right.yaml
/// (ROS camera calibration files), and frames.csv. The columns of frames.csv are stamp_s, left, right, and
/// the truth: height_m, approach_angle_deg, foe_u_px, foe_v_px, speed_m_s, pitch_deg, roll_deg, yaw_deg, x_m,
/// y_m. Columns of the truth are blank or missing when it is unknown.
struct DatasetFrame {
  ros::Time stamp;
  std::string left, right;  ///< paths of the images
  Truth truth;              ///< radians
};

struct Dataset {
  sensor_msgs::CameraInfo left, right;  ///< headers empty
  std::vector<DatasetFrame> frames;     ///< stamps strictly increasing
};

/// Reads one camera's ROS calibration file; the failure names the file.
Expected<sensor_msgs::CameraInfo> readCalibrationFile(const std::string& path);

/// Reads calibrations and frames.csv; the failure names file, line and column. Images are read one by one
/// with readImage().
Expected<Dataset> readDataset(const std::string& folder);

/// Reads a mono8 PNG of this size; the failure names the file and what was found.
Expected<cv::Mat> readImage(const std::string& path, cv::Size size);

}  // namespace uav_landing
