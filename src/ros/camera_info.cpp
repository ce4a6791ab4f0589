#include "camera_info.h"

namespace uav_landing {
namespace {

// Fixed-size row-major arrays of messages as matrices.
template <int kRows, int kColumns>
using RowMajor = Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor>;

constexpr const char* kCameraInfo = "camera_info: ";

}  // namespace

CameraCalibration toCalibration(const sensor_msgs::CameraInfo& info) {
  CameraCalibration calibration;
  calibration.width = static_cast<int>(info.width);
  calibration.height = static_cast<int>(info.height);
  calibration.distortion_model = info.distortion_model;
  calibration.D = info.D;
  calibration.K = Eigen::Map<const RowMajor<3, 3>>(info.K.data());
  calibration.R = Eigen::Map<const RowMajor<3, 3>>(info.R.data());
  calibration.P = Eigen::Map<const RowMajor<3, 4>>(info.P.data());
  calibration.binning_x = static_cast<int>(info.binning_x);
  calibration.binning_y = static_cast<int>(info.binning_y);
  calibration.roi = cv::Rect(static_cast<int>(info.roi.x_offset), static_cast<int>(info.roi.y_offset),
                             static_cast<int>(info.roi.width), static_cast<int>(info.roi.height));
  return calibration;
}

sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration, const std_msgs::Header& header) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = static_cast<uint32_t>(calibration.width);
  info.height = static_cast<uint32_t>(calibration.height);
  info.distortion_model = calibration.distortion_model;
  info.D = calibration.D;
  Eigen::Map<RowMajor<3, 3>>(info.K.data()) = calibration.K;
  Eigen::Map<RowMajor<3, 3>>(info.R.data()) = calibration.R;
  Eigen::Map<RowMajor<3, 4>>(info.P.data()) = calibration.P;
  info.binning_x = static_cast<uint32_t>(calibration.binning_x);
  info.binning_y = static_cast<uint32_t>(calibration.binning_y);
  info.roi.x_offset = static_cast<uint32_t>(calibration.roi.x);
  info.roi.y_offset = static_cast<uint32_t>(calibration.roi.y);
  info.roi.width = static_cast<uint32_t>(calibration.roi.width);
  info.roi.height = static_cast<uint32_t>(calibration.roi.height);
  return info;
}

Failure ofCameraInfo(const Failure& failure) {
  const bool of_parameter = failure.detail.rfind("rig/", 0) == 0;
  return of_parameter ? failure : Failure{failure.reason, kCameraInfo + failure.detail};
}

std::vector<std::string> ofCameraInfo(const std::vector<std::string>& warnings) {
  std::vector<std::string> named;
  for (const std::string& warning : warnings) named.push_back(kCameraInfo + warning);
  return named;
}

}  // namespace uav_landing
