#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <optional>

#include "uav_landing/image/rectification.h"

namespace uav_landing {
namespace benchmark {

/// What a user would otherwise run: rectification and dense block matching with the settings that
/// stereo_image_proc hands to OpenCV, then a ground plane by least squares over the disparities.
class BlockMatchingPeer {
 public:
  BlockMatchingPeer(const Rectifier& left, const Rectifier& right, cv::Ptr<cv::StereoMatcher> matcher);
  /// Disparity plane (a, b, c), d = a u + b v + c.
  cv::Vec3d process(const cv::Mat& left, const cv::Mat& right);

  static cv::Ptr<cv::StereoMatcher> blockMatcher();
  static cv::Ptr<cv::StereoMatcher> semiGlobalMatcher();

 private:
  const Rectifier &left_rectifier_, &right_rectifier_;
  cv::Ptr<cv::StereoMatcher> matcher_;
  cv::Mat left_, right_, disparity_;
};

/// The least that any method does that looks at whole images: two remaps and the 3x3 Sobel gradients of both.
class ImageFloor {
 public:
  ImageFloor(const CameraCalibration& left, const CameraCalibration& right);
  void process(const cv::Mat& left, const cv::Mat& right);

 private:
  struct View {
    cv::Mat map1, map2, rectified, gu, gv;
    explicit View(const CameraCalibration& calibration);
    void process(const cv::Mat& raw);
  };
  View left_, right_;
};

}  // namespace benchmark
}  // namespace uav_landing
