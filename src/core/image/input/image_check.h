#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/base/failure.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {

/// Tells why a rectified pair cannot be used. input_invalid: an image is not mono8 of the rig's size.
/// uniform_image: one of them is black, saturated or uniform inside its mask.
Failure checkPair(const RigModel& model, const cv::Mat& left, const cv::Mat& right);

/// Detects an image that equals the previous one bit by bit, as a frozen camera or driver gives it. It
/// compares every eighth row.
class RepeatedImage {
 public:
  /// image: mono8. False for the first image.
  bool check(const cv::Mat& image);
  void reset() { before_.release(); }

 private:
  cv::Mat before_;
};

/// The mask without the pixels whose window of this margin (pixels) reaches outside the mask.
cv::Mat erodeMask(const cv::Mat& mask, int margin);

/// Whether the mask is set at the pixel nearest to a place; false outside the image.
inline bool isSet(const cv::Mat& mask, double u, double v) {
  const int x = cvRound(u), y = cvRound(v);
  return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<uchar>(y, x) != 0;
}

}  // namespace uav_landing
