#include "peers.h"

#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace benchmark {
namespace {

constexpr int kDisparities = 64, kBlock = 15;

/// Least squares over the valid disparities of the lower half, every fourth pixel, refined twice without what
/// is off the plane.
cv::Vec3d fitPlane(const cv::Mat& disparity) {
  constexpr int kStep = 4, kPasses = 3;
  constexpr double kFixedPoint = 16, kTolerance = 1;
  cv::Vec3d plane;
  for (int pass = 0; pass < kPasses; ++pass) {
    cv::Matx33d A = cv::Matx33d::zeros();
    cv::Vec3d b;
    for (int v = disparity.rows / 2; v < disparity.rows; v += kStep)
      for (int u = 0; u < disparity.cols; u += kStep) {
        const double d = disparity.at<short>(v, u) / kFixedPoint;
        const cv::Vec3d x(u, v, 1);
        if (d <= 0 || (pass > 0 && std::abs(plane.dot(x) - d) > kTolerance)) continue;
        A += x * x.t();
        b += d * x;
      }
    cv::solve(A, b, plane, cv::DECOMP_SVD);
  }
  return plane;
}

}  // namespace

BlockMatchingPeer::BlockMatchingPeer(const Rectifier& left, const Rectifier& right,
                                     cv::Ptr<cv::StereoMatcher> matcher)
    : left_rectifier_(left), right_rectifier_(right), matcher_(std::move(matcher)) {}

cv::Vec3d BlockMatchingPeer::process(const cv::Mat& left, const cv::Mat& right) {
  left_rectifier_.rectify(left, left_);
  right_rectifier_.rectify(right, right_);
  matcher_->compute(left_, right_, disparity_);
  return fitPlane(disparity_);
}

cv::Ptr<cv::StereoMatcher> BlockMatchingPeer::blockMatcher() {
  return cv::StereoBM::create(kDisparities, kBlock);
}

cv::Ptr<cv::StereoMatcher> BlockMatchingPeer::semiGlobalMatcher() {
  return cv::StereoSGBM::create(0, kDisparities, kBlock);
}

ImageFloor::ImageFloor(const CameraCalibration& left, const CameraCalibration& right)
    : left_(left), right_(right) {}

ImageFloor::View::View(const CameraCalibration& calibration) {
  const CameraCalibration c = calibration.ofDeliveredImage();
  const Eigen::Matrix3d projection = c.P.leftCols<3>();
  cv::Mat K, R, P;
  cv::eigen2cv(c.K, K);
  cv::eigen2cv(c.R, R);
  cv::eigen2cv(projection, P);
  cv::initUndistortRectifyMap(K, cv::Mat(c.D, true), R, P, c.imageSize(), CV_16SC2, map1, map2);
}

void ImageFloor::View::process(const cv::Mat& raw) {
  cv::remap(raw, rectified, map1, map2, cv::INTER_LINEAR);
  cv::Sobel(rectified, gu, CV_16S, 1, 0);
  cv::Sobel(rectified, gv, CV_16S, 0, 1);
}

void ImageFloor::process(const cv::Mat& left, const cv::Mat& right) {
  left_.process(left);
  right_.process(right);
}

}  // namespace benchmark
}  // namespace uav_landing
