#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "uav_landing/base/failure.h"

namespace uav_landing {

/// One camera's calibration, field by field as in sensor_msgs/CameraInfo (REP 104), without ROS.
struct CameraCalibration {
  int width = 0;   ///< full-resolution image width, pixels
  int height = 0;  ///< full-resolution image height, pixels
  /// "plumb_bob" (up to 5 coefficients), "rational_polynomial" (8, 12 or 14), "equidistant" or "fisheye" (4).
  std::string distortion_model;
  std::vector<double> D;
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 4> P = Eigen::Matrix<double, 3, 4>::Zero();
  int binning_x = 0;  ///< 0 and 1 both mean no binning
  int binning_y = 0;
  cv::Rect roi;  ///< in full-resolution pixels; all zero means the full image

  bool operator==(const CameraCalibration& other) const;
  bool operator!=(const CameraCalibration& other) const { return !(*this == other); }

  /// Size of the image that this camera_info announces: the ROI divided by the binning.
  cv::Size imageSize() const;

  /// The same camera in pixels of the image that it delivers. K and P then contain ROI and binning as in
  /// image_geometry (c' = (c - offset) / binning, f' = f / binning). No ROI or binning remains.
  CameraCalibration ofDeliveredImage() const;
};

/// The rectified pair: two pinhole cameras with common rows and parallel axes. The right one is at b to the
/// right. Pixels are those of the delivered image (binning and ROI already applied).
struct StereoRig {
  cv::Size size;          ///< of both rectified images
  double fx = 0, fy = 0;  ///< pixels
  double cx = 0, cy = 0;  ///< principal point of the left image, pixels
  double cx_right = 0;    ///< principal point column of the right image, pixels
  double baseline = 0;    ///< metres

  Eigen::Matrix3d K() const;
  Eigen::Matrix3d Kinv() const;
  /// Ray K^-1 [u v 1]' of a left pixel; its third component is 1.
  Eigen::Vector3d ray(double u, double v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0}; }
  /// Pixel of a direction or point in the left frame (z must not be 0).
  Eigen::Vector2d project(const Eigen::Vector3d& x) const {
    return {fx * x.x() / x.z() + cx, fy * x.y() / x.z() + cy};
  }
  /// Column shift between the two images minus the disparity d, where d = (u_l - u_r) - (cx_l - cx_r).
  double principalOffset() const { return cx - cx_right; }
  /// f b, the product that turns inverse depth into disparity (eq 3).
  double fb() const { return fx * baseline; }
};

/// Checks one camera's calibration. The failure names the field ("K[0]: ...") and what was expected. It
/// refuses zero or NaN where a number is needed, D of the wrong length, and an unknown distortion_model. It
/// also refuses an R that is no rotation, and a ROI outside the image.
Failure checkCalibration(const CameraCalibration& calibration);

/// Rig of a calibrated pair. It fails when a calibration is wrong by itself, when the sizes differ, or when
/// the rows of the P matrices do not match. It also fails when the baseline (-P_right[3]/P_right[0]) is not
/// positive. Details of a failure start with "left" or "right" and name the field.
Expected<StereoRig> makeStereoRig(const CameraCalibration& left, const CameraCalibration& right);

}  // namespace uav_landing
