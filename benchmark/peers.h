#pragma once

#include <image_geometry/stereo_camera_model.h>
#include <sensor_msgs/Image.h>
#include <stereo_image_proc/processor.h>

#include <opencv2/core.hpp>

#include "opencv_rectifier.h"
#include "sequences.h"

namespace uav_landing {
namespace benchmark {

/// What a user would otherwise run: the library of stereo_image_proc with its node's initial settings (64
/// disparities, block 15), from raw images to disparities, then a ground plane through them by least squares.
class StereoImageProcPeer {
 public:
  using Processor = stereo_image_proc::StereoProcessor;

  StereoImageProcPeer(const Sequence& sequence, Processor::StereoType algorithm);
  /// Disparity plane (a, b, c), d = a u + b v + c.
  cv::Vec3d process(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& right);

  const cv::Mat& rectifiedLeft() const { return images_.left.rect; }
  const cv::Mat& rectifiedRight() const { return images_.right.rect; }

 private:
  image_geometry::StereoCameraModel model_;
  Processor processor_;
  stereo_image_proc::StereoImageSet images_;
};

/// The least work of any method that uses whole images: two remaps and the 3x3 Sobel gradients of both.
class ImageFloor {
 public:
  explicit ImageFloor(const Sequence& sequence);
  void process(const cv::Mat& left, const cv::Mat& right);

 private:
  struct View {
    OpenCvRectifier rectifier;
    cv::Mat rectified, gu, gv;
    explicit View(const CameraCalibration& calibration) : rectifier(calibration) {}
    void process(const cv::Mat& raw);
  };
  View left_, right_;
};

}  // namespace benchmark
}  // namespace uav_landing
