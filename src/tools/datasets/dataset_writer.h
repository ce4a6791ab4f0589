#pragma once

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>

#include "uav_landing/base/failure.h"
#include "uav_landing/results/truth.h"

namespace uav_landing {

/// Writes a dataset folder (see dataset.h). It writes to "<folder>.active"; finish() renames it, and without
/// finish() it is removed. It never writes to a folder that is not empty.
class DatasetWriter {
 public:
  explicit DatasetWriter(const std::string& folder);
  ~DatasetWriter();
  DatasetWriter(const DatasetWriter&) = delete;
  DatasetWriter& operator=(const DatasetWriter&) = delete;

  /// Makes the folders and writes the calibrations and the header of frames.csv.
  Failure open(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right);
  /// left, right: raw mono8.
  Failure write(const ros::Time& stamp, const cv::Mat& left, const cv::Mat& right, const Truth& truth);
  Failure finish();

 private:
  std::filesystem::path folder_, temporary_;
  std::ofstream frames_;
  int count_ = 0;
  bool open_ = false;
};

}  // namespace uav_landing
