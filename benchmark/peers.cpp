#include "peers.h"

#include <stereo_image_proc/DisparityConfig.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "camera_info.h"

namespace uav_landing {
namespace benchmark {
namespace {

/// Least squares over the valid disparities of the lower half, every fourth pixel, refined twice without
/// those off the plane.
cv::Vec3d fitPlane(const cv::Mat_<float>& disparity) {
  constexpr int kStep = 4, kPasses = 3;
  constexpr double kTolerance = 1;
  cv::Vec3d plane;
  for (int pass = 0; pass < kPasses; ++pass) {
    cv::Matx33d A = cv::Matx33d::zeros();
    cv::Vec3d b;
    for (int v = disparity.rows / 2; v < disparity.rows; v += kStep)
      for (int u = 0; u < disparity.cols; u += kStep) {
        const double d = disparity(v, u);
        const cv::Vec3d x(u, v, 1);
        if (d <= 0 || (pass > 0 && std::abs(plane.dot(x) - d) > kTolerance)) continue;
        A += x * x.t();
        b += d * x;
      }
    cv::solve(A, b, plane, cv::DECOMP_SVD);
  }
  return plane;
}

/// As the node does before it is reconfigured.
void setDefaults(stereo_image_proc::StereoProcessor& processor) {
  const auto& config = stereo_image_proc::DisparityConfig::__getDefault__();
  processor.setPreFilterSize(config.prefilter_size);
  processor.setPreFilterCap(config.prefilter_cap);
  processor.setCorrelationWindowSize(config.correlation_window_size);
  processor.setMinDisparity(config.min_disparity);
  processor.setDisparityRange(config.disparity_range);
  processor.setTextureThreshold(config.texture_threshold);
  processor.setUniquenessRatio(static_cast<float>(config.uniqueness_ratio));
  processor.setSpeckleSize(config.speckle_size);
  processor.setSpeckleRange(config.speckle_range);
  processor.setSgbmMode(config.fullDP ? 1 : 0);
  processor.setP1(static_cast<int>(config.P1));
  processor.setP2(static_cast<int>(config.P2));
  processor.setDisp12MaxDiff(config.disp12MaxDiff);
}

}  // namespace

StereoImageProcPeer::StereoImageProcPeer(const Sequence& sequence, Processor::StereoType algorithm) {
  model_.fromCameraInfo(toCameraInfo(sequence.left, {}), toCameraInfo(sequence.right, {}));
  processor_.setStereoType(algorithm);
  setDefaults(processor_);
}

cv::Vec3d StereoImageProcPeer::process(const sensor_msgs::ImageConstPtr& left,
                                       const sensor_msgs::ImageConstPtr& right) {
  if (!processor_.process(left, right, model_, images_,
                          Processor::LEFT_RECT | Processor::RIGHT_RECT | Processor::DISPARITY))
    throw std::runtime_error("stereo_image_proc refuses a pair");
  sensor_msgs::Image& image = images_.disparity.image;
  return fitPlane(cv::Mat_<float>(static_cast<int>(image.height), static_cast<int>(image.width),
                                  reinterpret_cast<float*>(image.data.data()), image.step));
}

ImageFloor::ImageFloor(const Sequence& sequence) : left_(sequence.left), right_(sequence.right) {}

void ImageFloor::View::process(const cv::Mat& raw) {
  rectifier.rectify(raw, rectified);
  cv::Sobel(rectified, gu, CV_16S, 1, 0);
  cv::Sobel(rectified, gv, CV_16S, 0, 1);
}

void ImageFloor::process(const cv::Mat& left, const cv::Mat& right) {
  left_.process(left);
  right_.process(right);
}

}  // namespace benchmark
}  // namespace uav_landing
