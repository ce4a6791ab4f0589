#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "opencv_rectifier.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {
namespace benchmark {

/// The paper's method to the letter, with OpenCV calls: Canny, Hough transform and RANSAC for the vanishing
/// point of each view; Harris corners, their image velocity by SSD and the focus of expansion; eq (1); SSD
/// along the rows, eqs (3) to (5), mean and a Kalman filter.
class PaperPipeline {
 public:
  PaperPipeline(const StereoRig& rig, const CameraCalibration& left, const CameraCalibration& right);

  struct Result {
    double approach_angle = 0;  ///< rad
    double height = 0;          ///< filtered, m
  };
  Result process(const cv::Mat& left, const cv::Mat& right, double duration);

 private:
  cv::Point2d vanishingPoint(const cv::Mat& image);
  cv::Point2d focusOfExpansion(const std::vector<cv::Point2f>& corners) const;
  double meanHeight(const std::vector<cv::Point2f>& corners, double angle) const;
  double filter(double height, double duration);

  StereoRig rig_;
  OpenCvRectifier left_rectifier_, right_rectifier_;
  cv::Mat left_, right_, last_left_, edges_;
  cv::Vec2d state_;  // height, vertical speed
  cv::Matx22d covariance_;
  bool started_ = false;
};

}  // namespace benchmark
}  // namespace uav_landing
