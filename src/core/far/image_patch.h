#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// A piece of an image, found again in the next one.
class ImagePatch {
 public:
  /// place: in the image; what lies outside is left out.
  void take(const cv::Mat& image, const cv::Rect& place);
  /// By how many whole pixels it has moved, within this reach: the least sum of squared differences.
  cv::Point movement(const cv::Mat& image, int reach) const;

 private:
  cv::Mat grey_;
  cv::Rect place_;
};

}  // namespace uav_landing
