#include "opencv_rectifier.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace benchmark {

OpenCvRectifier::OpenCvRectifier(const CameraCalibration& calibration) {
  const CameraCalibration c = calibration.ofDeliveredImage();
  const Eigen::Matrix3d projection = c.P.leftCols<3>();
  cv::Mat K, R, P;
  cv::eigen2cv(c.K, K);
  cv::eigen2cv(c.R, R);
  cv::eigen2cv(projection, P);
  cv::initUndistortRectifyMap(K, cv::Mat(c.D, true), R, P, c.imageSize(), CV_16SC2, map1_, map2_);
}

void OpenCvRectifier::rectify(const cv::Mat& raw, cv::Mat& rectified) const {
  cv::remap(raw, rectified, map1_, map2_, cv::INTER_LINEAR);
}

}  // namespace benchmark
}  // namespace uav_landing
