#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/base/failure.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {

/// What makes a rectified pair useless: not mono8 of the rig's size (input_invalid), or one of them black,
/// saturated or uniform inside its mask (uniform_image).
Failure checkPair(const RigModel& model, const cv::Mat& left, const cv::Mat& right);

/// Tells an image that is the one before, bit by bit: a camera or driver that hangs. Looks at every eighth
/// row.
class RepeatedImage {
 public:
  /// image: mono8. False for the first.
  bool check(const cv::Mat& image);
  void reset() { before_.release(); }

 private:
  cv::Mat before_;
};

/// The mask without what a window of this margin (pixels) around a pixel would take from outside it.
cv::Mat erodeMask(const cv::Mat& mask, int margin);

/// Whether the mask is set at the pixel nearest to a place; never beside the image.
inline bool isSet(const cv::Mat& mask, double u, double v) {
  const int x = cvRound(u), y = cvRound(v);
  return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<uchar>(y, x) != 0;
}

}  // namespace uav_landing
