#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {
namespace benchmark {

/// Rectification by OpenCV's own calls: fixed-point maps, made once, and cv::remap with bilinear
/// interpolation.
class OpenCvRectifier {
 public:
  explicit OpenCvRectifier(const CameraCalibration& calibration);
  void rectify(const cv::Mat& raw, cv::Mat& rectified) const;

 private:
  cv::Mat map1_, map2_;
};

}  // namespace benchmark
}  // namespace uav_landing
